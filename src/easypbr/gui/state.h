// What the parts of the GUI share: what they change, and what is only about looking at it.
#pragma once

#include <array>
#include <functional>
#include <set>
#include <string>

#include "easypbr/app/live_drawing.h"
#include "easypbr/gui/theme.h"

namespace easypbr::gui {

enum class Panel {
    scene,
    object,
    effects,
    lights,
    environment,
    camera,
    channels,
    statistics,
    animations,
    camera_path,
    recorder
};
inline constexpr int panel_count = 11;
inline constexpr float least_panel_scale = 0.5f, most_panel_scale = 4;
/// Name of a panel as it stands in menus; its key is F1 and on.
const char* panel_name(Panel panel);

constexpr std::array<bool, panel_count> all_panels() {
    std::array<bool, panel_count> all{};
    all.fill(true);
    return all;
}

/// Which panels are seen.
struct PanelLayout {
    std::array<bool, panel_count> open = all_panels();
    std::set<Panel> unfold;  ///< in the next frame
    bool shown = true;       ///< any of them
    bool keys = false;       ///< the list of keys
    int tree_rows = 0;       ///< of the objects' list in the last frame

    bool& is_open(Panel panel) { return open[size_t(panel)]; }
};

/// What the panels are drawn on.
struct Screen {
    Vec2i size{1, 1};       ///< of the window, pixels
    float scale = 1;        ///< of the panels: of the screen times panel_scale
    float panel_scale = 1;  ///< chosen by a person
    Theme theme = Theme::dark;
};

enum class Handle { move, turn, scale };

/// A drag of the manipulator, which goes on over frames.
struct HandleDrag {
    int axis = -1;     ///< none
    Vec2d from{0, 0};  ///< the pixel
    Vec3d centre{0, 0, 0};
    std::function<void(const Eigen::Affine3d& change)> apply;  ///< to what it was when the drag began
    std::function<void()> revert;                              ///< to what it was; both empty after it
};

/// The handles that move, turn and scale what is selected.
struct Manipulator {
    Handle handle = Handle::move;
    HandleDrag drag;
};

/// What the panel of the camera path shows beside the path.
struct PathPanel {
    std::string file = "camera_path.json";
    bool shows_path = true;  ///< over the picture
};

struct GuiState {
    explicit GuiState(app::LiveDrawing& l) : live(l) {}

    app::LiveDrawing& live;
    Screen screen;
    PanelLayout panels;
    Manipulator manipulator;
    PathPanel path_panel;
    std::string image_value;         ///< under the pointer, in an image beside the scene
    std::function<void()> own_menu;  ///< adds lines to the menu of panels

    app::Session& session() { return live.session(); }
    Settings& settings() { return live.session().settings(); }
    app::Selection& selection() { return live.selection(); }
    app::PathPlan& path() { return live.path(); }
    void notify(const std::string& text, bool is_error = false) { live.notifications().add(text, is_error); }
};

/// app::Edits::change_look(); errors become notifications.
void change_look(GuiState& state, const std::string& object, const std::string& property, const Value& value);

}  // namespace easypbr::gui
