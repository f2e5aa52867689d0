// LiveView: a session that a person looks at. Input events go in, a picture with the GUI comes out; with a
// window or without one.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/app/camera_control.h"
#include "easypbr/app/session.h"
#include "easypbr/gui/gui.h"
#include "easypbr/gui/image_panels.h"
#include "easypbr/gui/live_recording.h"
#include "easypbr/gui/state.h"
#include "easypbr/gui/user_panels.h"

namespace easypbr::gui {

/// Used by one thread at a time. While nothing changes nothing is drawn; while nothing moves the picture
/// refines up to image.samples frames; while something moves it is drawn quickly, on software contexts at a
/// lower resolution.
class LiveView {
  public:
    /// A view with a clock, a recorder and a player of its own.
    explicit LiveView(app::Session& session);
    /// With those of a program. All must outlive the view.
    LiveView(app::Session& session, app::Recorder& recorder, app::AnimationPlayer& player);
    ~LiveView();

    /// Takes what has happened in `seconds` and draws what is to be drawn. Returns whether the screen
    /// changed. Errors in what is drawn become notifications. Throws ArgumentError when it is called from a
    /// panel or callback of its own.
    bool update(const std::vector<app::InputEvent>& events, Vec2i size, float scale, double seconds);

    /// There is more to draw, though nothing happens.
    bool is_busy() const { return busy_; }
    /// Escape was pressed.
    bool wants_to_close() const { return state_.close; }

    /// The screen, RGBA u8, row 0 on top: picture and GUI. Throws ArgumentError before the first update().
    Image screen();
    /// The screen when all is refined; draws until then. What panels and callbacks change in every frame is
    /// taken as it is after a few.
    Image finished_screen(Vec2i size, float scale = 1);

    /// Panels of the user's own; their functions run within update(), while the panels are shown. May be
    /// called by such a function.
    void add_panel(const std::string& name, PanelFunction function);
    void remove_panel(const std::string& name);
    const UserPanels& panels() const { return panels_; }

    /// Shows an image in a window beside the scene; see ImagePanels.
    void show_image(const std::string& name, Image image, const ImageLook& look = {});
    void remove_image(const std::string& name);
    const ImagePanels& images() const { return images_; }

    /// The recorder's panel records; its frames are those of the clock.
    bool is_recording() const { return recording_.is_running(); }
    /// Ends what the recorder's panel began. Errors become notifications.
    void stop_recording();

    /// Calls `handler` for whatever happens but what the panels take for themselves, before the view acts on
    /// it; true keeps the view from that. What it throws becomes a notification. Returns a number for
    /// remove_event_handler().
    using EventHandler = std::function<bool(const app::InputEvent&)>;
    int on_event(EventHandler handler);
    void remove_event_handler(int number) { handlers_.erase(number); }
    /// A number that no other callback has.
    int next_callback_number() { return next_callback_++; }

    /// Calls a user's function. What it throws becomes a notification, once for each text; returns whether it
    /// threw nothing.
    bool guarded(const std::function<void()>& function);
    /// Within update(): in a panel's function or an event handler.
    bool is_updating() const { return updating_; }

    /// Adds what a file holds under the file's name, made unique; pictures with high range become the
    /// environment. Throws FileError, FormatError.
    void open(const std::filesystem::path& path);
    /// Shows the file again under `name` whenever it changes.
    void watch(const std::filesystem::path& path, const std::string& name);

    /// How large panels, text and handles are, 1 as the screen asks for. Throws ArgumentError unless it is
    /// from 0.5 to 4.
    void set_panel_scale(float scale);

    /// After a change to it call touch(), which has the GUI drawn again.
    GuiState& state() { return state_; }
    void touch() { gui_frames_ = 3; }
    const app::CameraControl& control() const { return control_; }

    /// Writes the settings; what Ctrl+S does.
    void save_settings(const std::filesystem::path& path);
    std::filesystem::path settings_file = "settings.json";

  private:
    struct Watched {
        std::filesystem::path path;
        std::string name;
        std::filesystem::file_time_type time;
    };
    void handle(const app::InputEvent& event);
    bool handled_by_user(const app::InputEvent& event);
    bool update_now(const std::vector<app::InputEvent>& events, Vec2i size, float scale, double seconds);
    bool shortcut(const app::InputEvent& event);
    bool control_shortcut(int key);
    void move_camera(const app::InputEvent& event);
    void zoom(Vec2d pixel, double factor);
    void click(Vec2d pixel);
    void fit();
    void keep_looks();
    void reload_changed(double seconds);
    /// Surfaces of the view as it is now.
    const app::PickBuffer& surfaces();

    bool draw_picture();
    bool draw_quickly(bool moving);
    /// How things moved in the time of a recording's frame before what is shown: along the animation and the
    /// camera path that rest there.
    app::Session::RefinedMotion shown_motion();
    bool refine();
    void show_picture();
    void show_pixels(const Image& image);
    void move_along_path(double seconds);
    void record();
    void say(const std::string& text, bool failed);
    Image finished_now();
    bool draw_screen(double seconds, bool always);
    bool is_moving() const;
    bool shows_path() const { return state_.show_panels && state_.show_path && !state_.path.keys().empty(); }
    bool shows_layers() const { return state_.channel != "picture"; }

    struct Own;
    LiveView(app::Session& session, std::unique_ptr<Own> own);

    app::Session& session_;
    std::unique_ptr<Own> own_;
    app::Recorder& recorder_;
    LiveRecording recording_;
    GuiState state_;
    app::CameraControl control_;
    Gui gui_;
    UserPanels panels_;
    ImagePanels images_;
    std::map<int, EventHandler> handlers_;
    int next_callback_ = 1;
    bool updating_ = false;
    double since_panels_ = 0;  ///< seconds since the user's panels were called
    std::string last_failure_;

    gl::Texture shown_, screen_;
    gl::Framebuffer screen_framebuffer_;
    uint64_t version_ = 0;  ///< of what is shown, see Session::picture_version(); 0: nothing
    Vec2i quick_size_{0, 0};
    std::string shown_channel_;
    uint64_t failed_version_ = 0;  ///< of what was begun last, with failed_: it could not be drawn
    Vec2i failed_size_{0, 0};
    app::Session::RefinedMotion motion_;      ///< that is refined, with motion_blur.enabled
    std::pair<double, double> motion_key_{};  ///< speed and frame rate that it is of
    int frames_ = 0;                          ///< refined so far
    double reduction_ = 1;                    ///< of the resolution while something moves
    int gui_frames_ = 3;                      ///< that are still to be drawn, so that the GUI settles
    bool busy_ = true, wants_hover_ = false, failed_ = false;
    Vec2d pointer_{-1, -1}, pressed_{0, 0};
    std::optional<app::PickBuffer> surfaces_;
    uint64_t surfaces_version_ = 0;
    std::optional<Vec3d> zoom_about_;  ///< while the pointer rests
    std::map<std::string, Mesh> known_;
    std::vector<Watched> watched_;
    double since_watch_ = 0;
    std::string last_error_;
    size_t told_ = 0;  ///< notifications on the screen
};

}  // namespace easypbr::gui
