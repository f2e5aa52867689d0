// LiveDrawing: a session that a person looks at. Input events go in, a picture comes out. It knows no window
// and no panels: a client that has some draws them over the picture.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/edits.h"
#include "easypbr/app/event_handlers.h"
#include "easypbr/app/live_picture.h"
#include "easypbr/app/live_recording.h"
#include "easypbr/app/navigation.h"
#include "easypbr/app/notifications.h"
#include "easypbr/app/path_editor.h"
#include "easypbr/app/scene_files.h"
#include "easypbr/app/user_panels.h"

namespace easypbr::app {

/// What a person has chosen in the scene.
struct Selection {
    std::string object;          ///< "car/wheel" for a child; empty: none
    std::string light;           ///< a light's name, or "key", "fill", "rim"; empty: none
    std::optional<Pick> picked;  ///< where the object was clicked
};

/// Which vertices of an object without faces and edges a person removes.
struct VertexFilter {
    enum class Shape {
        picked,    ///< the one that was clicked: Selection::picked
        ball,      ///< those within `radius` of it
        clip_box,  ///< those within clip.box of the settings
        faint,     ///< splats of an opacity below `opacity`
    } shape = Shape::picked;
    bool keeps = false;  ///< those of the shape stay, and the others are removed
    double radius = 0;   ///< in the object's units
    double opacity = 0;
};

/// The camera path that a person makes.
struct PathPlan {
    PathEditor editor;
    std::optional<size_t> key;          ///< the chosen one
    std::optional<size_t> look_at_key;  ///< the camera goes there with the next frame

    /// Chooses a key, and looks from it with the next frame.
    void look_from(size_t key);
    /// PathEditor::move() and remove(); the chosen key stays chosen, unless it is removed.
    void move(size_t from, size_t to);
    void remove(size_t removed);
};

/// What is asked for, to be done with the next frame.
struct LiveWishes {
    enum class Recording { none, picture, video, path, stop } recording = Recording::none;
    bool save = false;   ///< the settings, to LiveDrawing::settings_file
    bool close = false;  ///< left to the client
};

/// What has been recorded last.
struct RecordingReport {
    std::string text;
    bool failed = false;
};

/// Where a camera is copied to and pasted from; by itself a text of its own.
struct Clipboard {
    std::function<std::string()> read;
    std::function<void(const std::string&)> write;
};

/// What a client's panels ask of the next picture.
struct LiveNeeds {
    bool moving = false;      ///< a panel changes something from frame to frame: pictures should come quickly
    bool pass_times = false;  ///< see LiveShot
    bool surfaces = false;    ///< see LiveShot
    double resolution = 1;    ///< see LiveShot
    double longest_s = 0.07;  ///< see LiveShot
    bool refines = true;      ///< see LiveShot
    std::function<bool()> interrupt = {};  ///< see LiveShot
};

/// What a client shows, panels and all: for recordings with panels. A client without panels has none.
struct LiveScreens {
    std::function<Image()> finished;  ///< drawn to its end for the camera as it is
    std::function<Image()> shown;     ///< as it is
};

/// Used by one thread at a time. update() is a frame of a client without panels; one with panels calls its
/// parts, and draws the panels between draw() and end_frame().
class LiveDrawing {
  public:
    /// With a clock, a recorder and a player of its own.
    explicit LiveDrawing(Session& session);
    /// With those of a program. All must outlive it.
    LiveDrawing(Session& session, Recorder& recorder, AnimationPlayer& player);
    ~LiveDrawing();
    LiveDrawing(const LiveDrawing&) = delete;
    LiveDrawing& operator=(const LiveDrawing&) = delete;

    /// Takes what has happened in `seconds` and draws what is to be drawn. Returns whether picture() has
    /// changed. Errors become notifications.
    bool update(const std::vector<InputEvent>& events, Vec2i size, double seconds);

    /// Begins a frame: tells another size to the handlers, looks after files that have changed.
    void begin_frame(Vec2i size, double seconds);
    /// An event that a panel takes for itself: only the pointer's place is noted.
    void leave(const InputEvent& event);
    /// Offers an event to the program's handlers(). Returns whether one of them took it.
    bool offer(const InputEvent& event);
    /// Acts on an event: the camera moves, a click selects, files that were dropped are opened, Ctrl+Z,
    /// Ctrl+Shift+Z, Ctrl+Y, S, C, V and K do what docs/viewer.md says, Escape wishes to close. Of keys that
    /// repeat only undo and redo count.
    void handle(const InputEvent& event);
    /// Lets the time of the frame pass for camera, path and notifications, then takes a step of the picture.
    /// Returns whether it has changed.
    bool draw(const LiveNeeds& needs = {});
    /// All steps of the picture, as if nothing moved.
    void draw_finished(const LiveNeeds& needs = {});
    /// Ends a frame: records what is to be recorded, and notes what was changed for undo.
    void end_frame(const LiveNeeds& needs = {}, const LiveScreens& screens = {});

    /// There is more to draw, though nothing happens.
    bool is_busy() const;

    Session& session() { return session_; }
    AnimationPlayer& player() { return player_; }
    /// Of the last frame.
    Vec2i size() const { return size_; }
    const LivePicture& picture() const { return picture_; }
    /// What is seen in a pixel of the last frame's size. Throws as Session::pick_buffer().
    std::optional<Pick> pick(Vec2d pixel) { return picture_.surfaces(size_).at(pixel); }
    /// What is shown: "picture", "slices", or a layer's name.
    std::string channel = "picture";

    Selection& selection() { return selection_; }
    /// What the panels' next removal of vertices is of.
    VertexFilter& vertex_filter() { return vertex_filter_; }
    Edits& edits() { return edits_; }
    Navigation& navigation() { return navigation_; }
    Notifications& notifications() { return notifications_; }
    EventHandlers& handlers() { return handlers_; }
    UserPanels& panels() { return panels_; }
    /// UserPanels::call(); what the function sets is the program's, as what handlers() set.
    std::string call_panel(const std::string& name, Widgets& widgets);
    SceneFiles& files() { return files_; }
    Clipboard& clipboard() { return clipboard_; }
    LiveWishes& wishes() { return wishes_; }
    std::filesystem::path settings_file = "settings.json";

    PathPlan& path() { return path_; }
    /// A key of the camera path from what is seen now, after the chosen one. Throws as Session::camera().
    void add_path_key();
    /// Makes the path that is edited a turntable of eight seconds. Throws SceneError if nothing is shown.
    void set_turntable();

    /// What the next recording shall be.
    RecordingForm& recording_form() { return form_; }
    const LiveRecording& recording() const { return recording_; }
    const RecordingReport& report() const { return report_; }
    /// Ends what was begun by a wish. Errors become notifications.
    void stop_recording();

  private:
    struct Own;
    LiveDrawing(Session& session, std::unique_ptr<Own> own);

    bool offer_to_handlers(const InputEvent& event);
    bool shortcut(const InputEvent& event);
    void control_shortcut(const InputEvent& event);
    void move_camera(const InputEvent& event);
    void open(const std::vector<std::string>& paths);
    void move_along_path(double seconds);
    LiveShot shot(const LiveNeeds& needs);
    /// How things moved in the time of a recording's frame before what is shown: along the animation and the
    /// camera path that rest there.
    Session::RefinedMotion shown_motion(const Camera& now) const;
    void record(const LiveScreens& screens);
    void begin_recording(LiveWishes::Recording wish, const LiveScreens& screens);
    void tell(const std::string& text, bool failed);
    bool is_moving(const LiveNeeds& needs) const;

    Session& session_;
    std::unique_ptr<Own> own_;
    AnimationPlayer& player_;
    Notifications notifications_;
    EventHandlers handlers_{notifications_};
    LivePicture picture_;
    Navigation navigation_;
    Edits edits_;
    SceneFiles files_;
    UserPanels panels_;
    LiveRecording recording_;
    RecordingForm form_;
    RecordingReport report_;
    Selection selection_;
    VertexFilter vertex_filter_{.opacity = 0.1};
    PathPlan path_;
    LiveWishes wishes_;
    Clipboard clipboard_;
    Vec2i size_{1, 1};
    double seconds_ = 0;  ///< of the frame
    Vec2d pointer_{-1, -1};
};

}  // namespace easypbr::app
