#include "easypbr/gui/state.h"

#include "easypbr/core/error.h"

namespace easypbr::gui {

const char* panel_name(Panel panel) {
    constexpr const char* names[panel_count] = {"Scene",       "Object",      "Effects",  "Lights",
                                                "Environment", "Camera",      "Channels", "Statistics",
                                                "Animations",  "Camera path", "Recorder"};
    return names[size_t(panel)];
}

void change_look(GuiState& state, const std::string& object, const std::string& property,
                 const Value& value) {
    try {
        state.live.edits().change_look(object, property, value);
    } catch (const Error& error) {
        state.notify(error.what(), true);
    }
}

}  // namespace easypbr::gui
