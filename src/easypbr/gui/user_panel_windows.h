// The windows that a program's own panels are in, which a person may move, fold and close.
#pragma once

#include <map>
#include <string>

#include "easypbr/app/user_panels.h"
#include "easypbr/gui/state.h"

namespace easypbr::gui {

class UserPanelWindows {
  public:
    /// Draws all that are open, between ImGui's beginning and end of a frame. No lock of ImGui's is held
    /// while a function runs. What it throws is shown in its panel; the next frame calls it again.
    void draw(GuiState& state);
    /// A line for each in the menu of panels.
    void menu(const app::UserPanels& panels);

  private:
    struct Window {
        bool open = true;
        uint64_t revision = 0;  ///< of the panel that it was closed for
    };
    Window& window_of(const app::UserPanels& panels, const std::string& name);
    void draw_panel(GuiState& state, const std::string& name, Vec2 at);

    std::map<std::string, Window> windows_;
    float scale_ = 0;  ///< of the last frame
    bool rescaled_ = false;
};

}  // namespace easypbr::gui
