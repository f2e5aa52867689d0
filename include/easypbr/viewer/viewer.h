// Viewer: what a program holds. One line shows data, one line records a picture.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/animation_player.h"
#include "easypbr/app/clock.h"
#include "easypbr/app/custom_pass.h"
#include "easypbr/app/input.h"
#include "easypbr/app/picture.h"
#include "easypbr/app/recorder.h"
#include "easypbr/core/image.h"
#include "easypbr/remote/server.h"
#include "easypbr/scene/scene.h"

namespace easypbr {

class Animations;
struct Settings;

namespace app {
class Session;
class Widgets;
}  // namespace app
namespace gui {
class LiveView;
}

/// The one scene there is without being made: what show() fills and a Viewer without a scene draws.
Scene& default_scene();

/// Shows a mesh in the default scene.
void show(const Mesh& mesh, const std::string& name);

/// Removes everything from the default scene.
void clear();

/// Draws a scene. No window is opened and no GL context made until they are needed.
class Viewer {
    struct Parts;
    std::unique_ptr<Parts> parts_;  // First, because the recorder keeps references to them.

  public:
    /// Of the default scene.
    Viewer();
    explicit Viewer(const Scene& scene);
    /// Of the default scene, or another one, drawn by a device. Its driver is asked for with the first
    /// picture.
    explicit Viewer(DrawDevice device);
    Viewer(const Scene& scene, DrawDevice device);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;
    /// Settings from a file that --save-settings wrote, and a picture size.
    explicit Viewer(Vec2i size, const std::filesystem::path& settings = {});

    /// What draws, never `automatic`. Throws ContextError, as render() does.
    DrawDevice device();

    app::Recorder recorder;

    Scene& scene();
    Settings& settings();
    /// What draws; its header is the library's own.
    app::Session& session();

    /// The time of animations; see Clock. Frames of the window and those that the recorder adds let it go on;
    /// without both, images of render() do, unless they fail.
    app::Clock& clock();
    double time() const;
    double delta_time() const;

    /// Plays an animation of a file (by its name or number) from its start, by the time of the clock: that of
    /// the window, or of the frames that are recorded. Throws NameError, ArgumentError for a speed that is
    /// not finite.
    void play(const Animations& animations, const std::string& animation = "0", double speed = 1,
              bool loop = true);
    void pause();
    /// What plays, and where it is.
    app::AnimationPlayer& player();

    /// Lights the scene with an equirectangular picture (HDR, EXR, PNG, JPEG). Throws FileError, FormatError.
    void load_environment_map(const std::filesystem::path& path);
    /// Shows an image file behind everything: settings().background.mode is image, and background.image names
    /// the file, read at once; photographs are turned upright (io::load_upright_image()). Throws FileError,
    /// FormatError; then the background before stays.
    void load_background_image(const std::filesystem::path& path);
    /// Shows an image behind everything: settings().background.mode is image, and background.image names no
    /// file. It is there until that names one, or another image is set; a file of settings does not hold it.
    /// u8 and u16 are sRGB with straight alpha, f32 is linear and premultiplied by alpha. Throws
    /// ArgumentError when it is empty.
    void set_background_image(Image image);

    /// Draws the scene and returns RGBA, row 0 on top. What was automatic is latched in settings(). Throws
    /// ArgumentError (among others when the picture has more than 2^30 pixels), FileError (images that the
    /// settings name), ContextError.
    Image render(const app::PictureOptions& options = {});
    /// The same scene, camera and size in exact values through the pixels' centres (no anti-aliasing), an
    /// f32 image for each name: "albedo" (linear, alpha is 1 where there is something), "normal_world"
    /// (unit), "depth" (along the viewing direction, in world units), "roughness", "metallic", "occlusion"
    /// (the material's), "ambient_occlusion" (1: nothing occludes; needs ssao.enabled), "object_id" and
    /// "element_id" (1 + the number of the object and of its face or point). All are 0 where there is
    /// nothing. Of surfels that overlap, which pictures blend, the nearest's; but "ambient_occlusion" is that
    /// of pictures. Through a lens depth is that of the pixels' own rays, all else that of the nearest pixel
    /// of the picture without it. Throws NameError with the nearest name, and as render() does.
    std::map<std::string, Image> render_layers(const std::vector<std::string>& names,
                                               std::optional<Vec2i> size = std::nullopt);
    /// The scene as it is now and the camera of the next picture.
    app::Moment moment(std::optional<Vec2i> size = std::nullopt);

    /// The camera of the next picture.
    Camera camera();
    /// Pins the camera to a pose: settings().camera follows. A near plane that was inferred is inferred anew.
    void set_camera(const Camera& camera);
    /// With motion_blur.enabled a picture of several samples shows how things moved since the picture before.
    /// After this the next one shows none: nothing is known of before.
    void forget_motion();
    /// Focuses on what a pixel shows, (0, 0) the upper left one of a picture of this size (image.size when
    /// not given): settings().depth_of_field.focus_distance is pinned to its depth, which is returned; the
    /// rest stays as it is. Throws ArgumentError when the pixel is outside of the picture or shows nothing.
    double focus_at(int x, int y, std::optional<Vec2i> size = std::nullopt);
    /// Forgets what was inferred, so that the next picture infers it anew.
    void refit();

    /// Writes pictures from all around as one HTML file that is turned without a server. Returns the path.
    /// Throws FileError when it cannot be written, ArgumentError for options that cannot be met.
    std::filesystem::path save_html(const std::filesystem::path& path,
                                    const app::OrbitPageOptions& options = {});

    /// Writes the visible and the hidden edges of the scene, as the camera sees it, as an SVG file. Returns
    /// the path. It appears whole or not at all. Throws FileError when it cannot be written, ArgumentError
    /// unless it is named .svg.
    std::filesystem::path save_svg(const std::filesystem::path& path,
                                   const app::LineDrawingOptions& options = {});

    /// Every value, chosen and inferred, of the last picture, with the hashes of the files it was made from.
    /// Throws ArgumentError where the settings name a file, or the scene has a light, whose name is not
    /// UTF-8; of `files` such are left out, with a warning. Throws FileError.
    void save_settings(const std::filesystem::path& path,
                       const std::vector<std::filesystem::path>& files = {});
    /// Takes over settings and lights from a file that save_settings() wrote. Files with another content than
    /// then are reported as warnings.
    void load_settings(const std::filesystem::path& path);
    /// Sets what a preset says: "dark", "flat", "paper", "studio", or a settings file, which need not say
    /// all. The rest stays; what was inferred is inferred anew, but for the camera. Throws NameError with the
    /// nearest name, FileError, FormatError.
    void apply_preset(const std::string& name_or_path);

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
    std::optional<app::Pick> pick(Vec2d pixel, std::optional<Vec2i> size = std::nullopt);

    /// What the window would show: picture and panels, refined; needs no display. `scale` is that of the
    /// panels, from 0.5 to 4.
    Image screenshot(std::optional<Vec2i> size = std::nullopt, float scale = 1);

    /// A panel of the user's own in the window, drawn by `function` in each of its frames, and in the pages
    /// of servers and channels, on their threads (see remote::Server::add_panel()):
    /// view.add_panel("Training", [&](app::Widgets& ui) { ui.slider("rate", rate, 0, 1); }). What it throws
    /// is shown in the panel. In the window it may use this viewer, but for update(), show() and
    /// screenshot().
    void add_panel(const std::string& name, std::function<void(app::Widgets&)> function);
    void remove_panel(const std::string& name);

    /// Shows an image in the window, beside the scene; headless it is kept for screenshots. Of 1, 3 or 4
    /// channels and at most 16384 pixels a side; values are shown as they are. Under the name of one that is
    /// there it takes its place.
    void show_image(const std::string& name, Image image, const app::ImageLook& look = {});
    void remove_image(const std::string& name);

    /// Functions that update() calls before and after it draws; what they throw is shown in the window and
    /// the loop goes on. Numbers for remove_callback().
    int before_draw(std::function<void()> function);
    int after_draw(std::function<void()> function);
    /// Calls `handler` for whatever happens in the window (mouse, keys, dropped files, another size) but what
    /// the panels take for themselves, before the view acts on it; true keeps the view from that. What it
    /// throws becomes a notification. A number for remove_callback().
    int on_event(std::function<bool(const app::InputEvent&)> handler);
    void remove_callback(int number);

    /// The GUI behind window and screenshots.
    gui::LiveView& live();

    /// Shows the scene in browsers from now on, beside what the program does: what it changes in the scene is
    /// seen, and what it changes in settings() once tell_servers() or update() is called. Clients move a
    /// camera and change settings of their own; what they hide is hidden in the scene. The server ends with
    /// its last handle. Custom passes and panels are not shown. Throws as remote::Server does.
    std::shared_ptr<remote::Server> serve(const remote::ServeOptions& options = {});
    /// The same for clients whose messages the program itself carries, as a notebook's kernel does.
    std::shared_ptr<remote::Channel> open_channel();
    /// Changes for the clients of servers and channels what has changed in settings().
    void tell_servers();

    /// Draws a custom pass in every picture from now on; one of the same name is replaced. See
    /// app/custom_pass.h. Throws ArgumentError for none.
    void add_pass(const std::string& name, app::Stage stage, std::shared_ptr<app::Pass> pass);
    /// Throws NameError when there is none of this name.
    void remove_pass(const std::string& name);

    /// Adds or replaces a light of the scene.
    void add_light(const std::string& name, const Light& light);
    /// Throws NameError when there is none of this name.
    void remove_light(const std::string& name);

  private:
    bool update_window();

    template <class Front>
    std::shared_ptr<Front> with_panels(std::shared_ptr<Front> front) const;
    template <class Work>
    void for_front_ends(Work&& work);

    std::vector<std::pair<std::string, std::function<void(app::Widgets&)>>> panels_;
    std::vector<std::weak_ptr<remote::Server>> servers_;
    std::vector<std::weak_ptr<remote::Channel>> channels_;
    struct Window;
    Window& window();
    static void shut(Window& window);
    std::unique_ptr<Window> window_;
};

}  // namespace easypbr
