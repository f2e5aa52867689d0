// Viewer: what a program holds. One line shows data, one line records a picture.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "easypbr/app/animation_player.h"
#include "easypbr/app/clock.h"
#include "easypbr/app/input.h"
#include "easypbr/app/output.h"
#include "easypbr/app/recorder.h"
#include "easypbr/app/session.h"
#include "easypbr/gui/shown_image.h"

namespace easypbr {

namespace gui {
class LiveView;
class Widgets;
}  // namespace gui

/// The one scene there is without being made: what show() fills and a Viewer without a scene draws.
Scene& default_scene();

/// Shows a mesh in the default scene.
inline void show(const Mesh& mesh, const std::string& name) {
    default_scene().show(mesh, name);
}

/// Removes everything from the default scene.
inline void clear() {
    default_scene().clear();
}

/// Draws a scene. No window is opened and no GL context made until they are needed.
class Viewer {
    // First, because the recorder keeps references to them.
    std::unique_ptr<app::Session> session_;
    std::unique_ptr<app::Clock> clock_;
    std::unique_ptr<app::AnimationPlayer> player_;

  public:
    Viewer() : Viewer(default_scene()) {}
    explicit Viewer(const Scene& scene);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;
    /// Settings from a file that --save-settings wrote, and a picture size.
    explicit Viewer(Vec2i size, const std::filesystem::path& settings = {});

    app::Recorder recorder;

    Scene& scene() { return session_->scene(); }
    Settings& settings() { return session_->settings(); }
    app::Session& session() { return *session_; }

    /// The time of animations; see Clock. Frames that the recorder adds let it go on.
    app::Clock& clock() { return *clock_; }
    double time() const { return clock_->time(); }
    double delta_time() const { return clock_->delta_time(); }

    /// Plays an animation of a file (by its name or number) from its start, by the time of the clock: that of
    /// the window, or of the frames that are recorded. Throws NameError, ArgumentError for a speed that is
    /// not finite.
    void play(const Animations& animations, const std::string& animation = "0", double speed = 1,
              bool loop = true);
    void pause() { player_->pause(); }
    /// What plays, and where it is.
    app::AnimationPlayer& player() { return *player_; }

    /// Lights the scene with an equirectangular picture (HDR, EXR, PNG, JPEG). Throws FileError, FormatError.
    void load_environment_map(const std::filesystem::path& path);

    Image render(const app::PictureOptions& options = {}) { return session_->render(options); }
    Camera camera() { return session_->camera(); }
    void set_camera(const Camera& camera) { session_->set_camera(camera); }
    /// See app::Session.
    void forget_motion() { session_->forget_motion(); }
    /// See app::Session::focus_at().
    double focus_at(int x, int y) { return session_->focus_at(x, y); }
    void refit() { session_->refit(); }

    /// Opens the window at the first call; then shows what has changed and does what mouse and keys ask for.
    /// Waits up to 16 ms for something to happen and draws nothing while nothing changes. False when the
    /// window has been closed: while (view.update()) ... Every call is a frame of the clock, and one of the
    /// recording while the recorder records. Throws ContextError when there is no display, or when it has
    /// gone away (a recording is finished before), and as Recorder::add_frame().
    bool update();
    /// Shows the window, again when it has been closed, until it is closed.
    void show();
    /// Lets update() open the window again after it has been closed.
    void reopen();
    /// Closes the window; update() returns false from now on, until show().
    void close();
    bool is_open() const;

    /// What lies under a pixel of a picture of `size` (image.size when not given), counted from its top left
    /// corner; nothing where there is no surface.
    std::optional<app::Pick> pick(Vec2d pixel, std::optional<Vec2i> size = std::nullopt) {
        return session_->pick(pixel, size);
    }

    /// What the window would show: picture and panels, refined; needs no display.
    Image screenshot(std::optional<Vec2i> size = std::nullopt, float scale = 1);

    /// A panel of the user's own in the window, drawn by `function` in each of its frames:
    /// view.add_panel("Training", [&](gui::Widgets& ui) { ui.slider("rate", rate, 0, 1); }). What it throws
    /// is shown in the panel. It may use this viewer, but for update(), show() and screenshot().
    void add_panel(const std::string& name, std::function<void(gui::Widgets&)> function);
    void remove_panel(const std::string& name);

    /// Shows an image in the window, beside the scene; headless it is kept for screenshots. Of 1, 3 or 4
    /// channels; values are shown as they are. Under the name of one that is there it takes its place.
    void show_image(const std::string& name, Image image, const gui::ImageLook& look = {});
    void remove_image(const std::string& name);

    /// Functions that update() calls before and after it draws; what they throw is shown in the window and
    /// the loop goes on. Numbers for remove_callback().
    int before_draw(std::function<void()> function);
    int after_draw(std::function<void()> function);
    /// See gui::LiveView::on_event(): mouse, keys, dropped files, another size.
    int on_event(std::function<bool(const app::InputEvent&)> handler);
    void remove_callback(int number);

    /// The GUI behind window and screenshots.
    gui::LiveView& live();

    /// Draws a pass of one's own in every picture from now on; one of the same name is replaced. See
    /// render/custom_pass.h.
    void add_pass(const std::string& name, render::Stage stage, std::shared_ptr<render::Pass> pass) {
        session_->add_pass(name, stage, std::move(pass));
    }
    void remove_pass(const std::string& name) { session_->remove_pass(name); }

    /// Adds or replaces a light of the scene.
    void add_light(const std::string& name, const Light& light) { scene().set_light(name, light); }
    void remove_light(const std::string& name) { scene().remove_light(name); }

  private:
    bool update_window();

    struct Window;
    Window& window();
    static void shut(Window& window);
    std::unique_ptr<Window> window_;
};

}  // namespace easypbr
