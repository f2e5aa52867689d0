// Session: a scene, settings and a renderer; everything a viewer is, without a window.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/backdrop.h"
#include "easypbr/app/drawn.h"
#include "easypbr/app/kept_device.h"
#include "easypbr/app/latched_content.h"
#include "easypbr/app/lens.h"
#include "easypbr/app/motion_memory.h"
#include "easypbr/app/picking.h"
#include "easypbr/app/picture.h"
#include "easypbr/app/scene_warnings.h"
#include "easypbr/app/settings_files.h"
#include "easypbr/app/tiled_picture.h"
#include "easypbr/app/view_point.h"
#include "easypbr/core/image.h"
#include "easypbr/gl/context.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/scene.h"

namespace easypbr {
struct ResolvedSettings;
struct Settings;
}  // namespace easypbr

namespace easypbr::app {

class Pass;
struct Prepared;

/// Seconds that the steps of the last picture took.
struct Timing {
    double context = 0;  ///< making the GL context; 0 when it was there
    double images = 0;   ///< reading the environment and the images that the settings name
    double draw = 0;     ///< auto parameters, upload and all frames
    double read = 0;     ///< reading the picture back
};

/// Throws ArgumentError unless a picture may be of `size`: sides from 1 to 65536 pixels, 2^30 in all.
void check_picture_size(Vec2i size);

/// Throws ArgumentError unless a picture of `size` has the pixel, (0, 0) the upper left one.
void check_focus(Vec2i pixel, Vec2i size);

/// May be used from any thread, by one at a time; load_environment() alone may run beside context_info().
/// The GL context is made at the first picture. One that is lost is replaced, and everything is uploaded and
/// drawn again: see KeptDevice.
class Session {
  public:
    explicit Session(const Scene& scene = {});
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    /// Another session of the same scene and, so far, the same settings, that draws by the same device: what
    /// is uploaded and the targets are there once. All that share a device are used by one thread at a time;
    /// what one draws ends the refinement of the others.
    Session beside() const;

    Scene& scene() { return scene_; }
    const Scene& scene() const { return scene_; }
    Settings& settings() { return *settings_; }
    const Settings& settings() const { return *settings_; }

    /// Takes settings over as they are, latched values included.
    void replace_settings(const Settings& settings);

    /// Draws the scene and returns RGBA, row 0 on top; in tiles where the picture is too large to be drawn at
    /// once. What was automatic is latched in settings(). Throws ArgumentError (among others when the picture
    /// has more than max_picture_pixels), FileError (images that the settings name), ContextError.
    Image render(const PictureOptions& options = {});

    /// The same picture, not read: see Drawn.
    Drawn draw(const PictureOptions& options = {});
    /// draw() that waits until the driver is done: for measuring.
    Drawn draw_frame(const PictureOptions& options = {});

    /// The same scene, camera and size in exact values through the pixels' centres (no anti-aliasing).
    /// Through a lens depth is that of the pixels' own rays, all else the nearest drawn pixel's. Of discs
    /// that overlap the nearest counts alone, but for ambient occlusion.
    std::map<std::string, Image> render_layers(const std::vector<std::string>& names,
                                               std::optional<Vec2i> size = std::nullopt);

    /// What the pixels' centres see. With `picture` the picture that the options ask for is drawn in the same
    /// go. `moment` is drawn in place of the session's scene and camera (no picture then).
    Drawn draw_surfaces(const PictureOptions& options, bool picture, const Moment* moment = nullptr);
    /// The scene as it is now and the camera of the next picture.
    Moment moment(std::optional<Vec2i> size = std::nullopt);

    /// Focuses on what a pixel shows, (0, 0) the upper left one of a picture of this size:
    /// settings().depth_of_field.focus_distance is pinned to its depth, which is returned; the rest stays as
    /// it is. Throws ArgumentError when the pixel is outside of the picture or shows nothing.
    double focus_at(int x, int y, std::optional<Vec2i> size = std::nullopt);

    /// With motion_blur.enabled a picture of several samples shows how things moved since the picture before.
    /// After this the next one shows none: nothing is known of before.
    void forget_motion() { motion_.forget(); }
    /// The next picture's motion begins where things are now, as if they had been drawn from this camera;
    /// none: from where the picture's own is.
    void begin_motion(const std::optional<Camera>& from = std::nullopt) {
        motion_.begin(scene_.snapshot(), from);
    }
    /// In the next picture these meshes moved so, and the camera since `from` (none: as it did), whatever
    /// they did since the picture before: for what jumps, as an animation that goes around.
    void replace_motion(const MovedMeshes& moved, const std::optional<Camera>& from = std::nullopt) {
        motion_.replace(moved, from);
    }

    /// Names of what is visible; the layer "object_id" holds 1 + the place in this list.
    std::vector<std::string> object_names() const;

    /// A picture that gets better with every call: one more frame of draw()'s, whose picture it is, bit for
    /// bit, after the last. Begins anew when anything that is drawn has changed, or when something else
    /// was drawn meanwhile; does nothing when all frames are there. Without `finish`, the frame is added but
    /// the picture stays as it was. What it shows of motion is `motion`, not what was drawn before; another
    /// object begins anew.
    using RefinedMotion = std::shared_ptr<const Motion>;
    struct Refinement {
        int frames = 0, total = 0;
        bool began = false;  ///< with this call
        bool drew = false;   ///< in this call
        Drawn drawn = {};    ///< the picture of the frames so far, as it was finished last
    };
    Refinement refine(const PictureOptions& options = {}, bool finish = true,
                      const RefinedMotion& motion = {});

    /// A number that grows whenever a picture of this size would be another one.
    uint64_t picture_version(std::optional<Vec2i> size = std::nullopt);

    /// What is seen in each pixel of the picture that would be drawn now, as surfaces.
    PickBuffer pick_buffer(std::optional<Vec2i> size = std::nullopt);
    /// What is seen in the pixel that the point lies in, counted from the picture's top left corner; nothing
    /// where there is no surface.
    std::optional<Pick> pick(Vec2d pixel, std::optional<Vec2i> size = std::nullopt) {
        return pick_buffer(size).at(pixel);
    }

    /// The camera of the next picture with its target.
    ViewPoint view_point(std::optional<Vec2i> size = std::nullopt);
    /// The axis of the next picture that points up.
    Vec3d up();
    /// Pins the camera, as set_camera(), and keeps its target; an automatic near plane comes as near as the
    /// camera.
    void set_view_point(const ViewPoint& view);
    /// What covers the picture's sides where it is shown, such as a menu bar: an automatic camera that is not
    /// latched yet leaves it free.
    void set_insets(const Insets& insets) { insets_ = insets; }
    const Insets& insets() const { return insets_; }
    /// The side of the next picture that its legend and colour bars take, which an automatic camera leaves
    /// free.
    Insets annotation_strip(std::optional<Vec2i> size = std::nullopt);

    /// Draws a pass of the program's own in every picture from now on; one of the same name is replaced. See
    /// app/custom_pass.h.
    void add_pass(const std::string& name, Stage stage, std::shared_ptr<Pass> pass);
    /// Throws NameError when there is none of this name.
    void remove_pass(const std::string& name);

    /// The context and the renderer, made when there are none yet: to draw on from the picture. A context
    /// that is lost is replaced first, unless it is current: objects made in it are void then.
    gl::Context& context();
    /// Another number for another context.
    uint64_t device_number() const { return device_.number(); }
    /// The context is lost and current, so that it cannot be replaced yet.
    bool is_stuck() const { return device_.is_stuck(); }
    render::Renderer& renderer();

    /// Everything that the next picture would be drawn with. Nothing is latched.
    ResolvedSettings resolve(std::optional<Vec2i> size = std::nullopt);

    /// Lights the scene with a file: settings().environment.file, read at once. Throws FileError,
    /// FormatError.
    void load_environment(const std::filesystem::path& path);
    /// Shows an image file behind everything: settings().background.mode is image, and background.image names
    /// the file, read at once. Throws FileError, FormatError; then the background before stays.
    void load_background(const std::filesystem::path& path);
    /// Shows an image behind everything: settings().background.mode is image, and background.image names no
    /// file. Throws ArgumentError when it is empty.
    void set_background(Image image);

    /// Pins the camera to a pose: settings().camera follows. A near plane that was inferred is inferred anew.
    void set_camera(const Camera& camera);
    /// The camera of the next picture.
    Camera camera();

    /// Forgets what was inferred, so that the next picture infers it anew.
    void refit();

    /// Which device draws, from the first picture on. Throws ArgumentError when another one was drawn by
    /// already.
    void use_device(DrawDevice device) { device_.ask_for(device); }
    /// What draws; made when there is nothing yet.
    const gl::ContextInfo& context_info();

    /// From which size on render() and render_layers() draw in tiles; without this what the context can draw.
    void limit_tiles(const render::TileLimits& limits) { tile_limits_ = limits; }

    const Timing& timing() const { return timing_; }

    /// See render::Renderer: false leaves all triangles to the driver.
    void allow_native_geometry(bool allow) { renderer().allow_native_geometry(allow); }
    /// Without a GPU, pixels are shaded natively where they can be; false leaves them to the driver.
    void allow_native_shading(bool allow) { renderer().allow_native_shading(allow); }

    /// See render::Renderer. 0 before the first picture.
    uint64_t shadow_maps_drawn() const {
        return device_->renderer ? device_->renderer->shadow_maps_drawn() : 0;
    }

  private:
    /// Snapshot, images, auto parameters.
    Prepared prepare(const PictureOptions& options);
    /// All but the auto parameters.
    Prepared gather(const PictureOptions& options);
    /// The auto parameters of what is gathered.
    void infer(Prepared& prepared);
    SceneSnapshot snapshot();
    /// An automatic camera that is not latched yet leaves the insets and the annotation's strip free.
    ResolvedSettings resolve_framed(const SceneSnapshot& scene, Vec2i size,
                                    std::optional<int> samples = std::nullopt) const;
    /// Before anything is drawn: apply_lens(); outdates what was drawn before. Returns what will be drawn, a
    /// picture, surfaces, or both.
    Drawn begin(Prepared& prepared, bool picture, bool surfaces);
    /// Sets the lens of what will be drawn. Where it or that of the motion's camera warps, replaces camera,
    /// size and the camera that the motion begins from by what has to be drawn, and a background image by one
    /// that is put behind the warped picture.
    void apply_lens(Drawn& drawn, Prepared& prepared, bool picture);
    /// Of a picture that a lens warps: leaves a background image out of what is drawn, and puts it behind the
    /// warped picture. It is in the picture's pixels, which the lens made.
    void put_image_behind(Drawn& drawn, Prepared& prepared);
    /// What of a warped picture that was just drawn must not be mixed; empty: nothing.
    static void keep_exact(Drawn& drawn, const Image& exact);
    /// What lies over the picture.
    void annotate(Drawn& drawn, const Prepared& prepared);
    TiledPicture tiled(const Prepared& prepared) const;
    /// Keeps what was inferred, unless there was nothing to infer it from.
    void latch_from(const Prepared& prepared);
    Vec2i size_or(std::optional<Vec2i> size) const;
    Drawn draw_once(const PictureOptions& options);
    void wait_for(const Drawn& drawn);
    Refinement refine_once(const PictureOptions& options, bool finish, const RefinedMotion& motion);
    std::map<std::string, Image> render_layers_once(const std::vector<std::string>& names,
                                                    const std::vector<render::Layer>& layers,
                                                    std::optional<Vec2i> size);
    PickBuffer pick_once(std::optional<Vec2i> size);
    Drawn draw_surfaces_once(const PictureOptions& options, bool picture, const Moment* moment);

    Scene scene_;
    std::unique_ptr<Settings> settings_;
    Timing timing_;
    SettingsFiles files_;
    std::optional<std::string> environment_hash_;  ///< what was latched belongs to this environment
    LatchedContent latched_content_;
    LensCache lenses_;
    BackdropCache backdrops_;
    MotionMemory motion_;
    SceneWarnings warnings_;
    std::vector<render::CustomPass> passes_;
    std::optional<render::TileLimits> tile_limits_;
    Insets insets_;
    KeptDevice device_;

    /// What refine() adds frames to; nothing: it has to begin.
    struct Refined;
    std::unique_ptr<Refined> refined_;
    /// What picture_version() saw last.
    struct Version {
        std::unique_ptr<Prepared> of;
        std::unique_ptr<Settings> settings;  ///< that it was inferred from
        Insets insets;
        uint64_t number = 0;
    };
    Version version_;
};

}  // namespace easypbr::app
