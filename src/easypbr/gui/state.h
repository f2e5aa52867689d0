// What the parts of the GUI share: the session they change and what is only about looking at it.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/app/animation_player.h"
#include "easypbr/app/history.h"
#include "easypbr/app/path_editor.h"
#include "easypbr/app/session.h"
#include "easypbr/gui/live_recording.h"
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

enum class Handle { move, turn, scale };

/// What the drawing takes.
struct Statistics {
    uint64_t pictures = 0;      ///< drawn since the beginning, refinement apart
    int frames = 0, total = 0;  ///< of the picture that is being refined
    double frame_seconds = 0;   ///< of the last frame
    Vec2i size{0, 0};           ///< of the picture, smaller while it moves on slow machines
    std::vector<std::pair<std::string, double>> passes;  ///< milliseconds of the last frame, when measured
};

struct Notification {
    std::string text;
    bool is_error = false;
    double seconds_left = 0;
};

/// A drag of the manipulator, which goes on over frames.
struct HandleDrag {
    int axis = -1;  ///< none
    Vec2 from{0, 0};
    Vec3d centre{0, 0, 0};
    std::function<void(const Eigen::Affine3d& change)> apply;  ///< to what it was when the drag began
};

using app::LookChange;

/// What the recorder's panel asks for.
enum class RecorderWish { none, picture, video, path, stop };

constexpr std::array<bool, panel_count> all_panels() {
    std::array<bool, panel_count> all{};
    all.fill(true);
    return all;
}

struct GuiState {
    explicit GuiState(app::Session& s) : session(s) {}

    app::Session& session;
    std::optional<ResolvedSettings> resolved;  ///< of the last frame
    Vec2i size{1, 1};                          ///< of the window
    float scale = 1;                           ///< of the panels: of the screen times panel_scale
    float panel_scale = 1;                     ///< chosen by a person

    std::array<bool, panel_count> open = all_panels();
    std::set<Panel> unfold;  ///< in the next frame
    bool show_panels = true, show_keys = false;
    Theme theme = Theme::dark;

    int tree_rows = 0;   ///< of the objects' list in the last frame
    std::string object;  ///< selected, "car/wheel" for a child; empty: none
    std::string light;   ///< selected: a light's name, or "key", "fill", "rim"
    Handle handle = Handle::move;
    HandleDrag drag;
    bool handles_pointer = false;  ///< the pointer is on the manipulator
    std::optional<app::Pick> hovered, picked;
    std::string channel = "picture";  ///< what is shown: this, "slices", or a layer's name
    Statistics statistics;
    std::vector<Notification> notifications;
    app::History history;

    app::PathEditor path;
    std::optional<size_t> path_key;     ///< the chosen one
    std::optional<size_t> look_at_key;  ///< the camera goes there
    std::string path_file = "camera_path.json";
    bool show_path = true;
    const app::PickBuffer* surfaces = nullptr;  ///< of what is shown, where they are known

    app::AnimationPlayer* player = nullptr;

    RecordingForm form;
    RecorderWish wish = RecorderWish::none;
    const LiveRecording* recording = nullptr;
    bool shows_recording = false;  ///< the picture is a recording's frame, whose shape is its own
    std::string recorder_says;     ///< of the last recording
    bool recorder_failed = false;

    std::string image_value;  ///< under the pointer, in an image beside the scene

    std::map<std::string, std::map<std::string, LookChange>> looks;  ///< by object, by property
    std::set<std::string> changed_looks, changed_poses;              ///< objects, since the history was noted
    std::set<std::string> changed_lights;                            ///< the same
    bool close = false, fit = false, save = false;

    std::map<std::string, Eigen::AlignedBox2d> places;  ///< of items in the last frame, see note_place()
    std::function<void()> own_menu;                     ///< adds lines to the menu of panels

    std::function<std::string()> read_clipboard;
    std::function<void(const std::string&)> write_clipboard;

    bool& is_open(Panel panel) { return open[size_t(panel)]; }
    Settings& settings() { return session.settings(); }
    void notify(const std::string& text, bool is_error = false) {
        notifications.push_back({text, is_error, is_error ? 12.0 : 5.0});
    }
};

/// The mesh of a node's name, "car" or "car/wheel"; nothing when there is none.
std::optional<Mesh> node_named(const Scene& scene, const std::string& name);

/// Changes a node's look now and whenever other data are shown under its name. Errors become notifications.
void change_look(GuiState& state, const std::string& object, const std::string& property,
                 const LookChange& change);

/// Before an object is moved: undo() puts it back.
void will_move(GuiState& state, const std::string& object, const Mesh& node);
/// Before a light of the scene is added, changed or removed.
void will_change_light(GuiState& state, const std::string& name);
/// Notes settings and what was changed for undo().
void note_history(GuiState& state);

/// Undo or redo; nothing happens when there is nothing to.
void undo(GuiState& state);
void redo(GuiState& state);

}  // namespace easypbr::gui
