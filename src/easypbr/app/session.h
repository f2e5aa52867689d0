// Session: a scene, settings and a renderer; everything a viewer is, without a window.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/annotation.h"
#include "easypbr/app/lens.h"
#include "easypbr/app/picking.h"
#include "easypbr/app/tiled_picture.h"
#include "easypbr/app/view_point.h"
#include "easypbr/core/image.h"
#include "easypbr/gl/context.h"
#include "easypbr/gl/readback.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/motion.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

using render::Encoding;

/// What to draw; a value that is not given comes from the settings.
struct PictureOptions {
    std::optional<Vec2i> size;
    std::optional<int> samples;
    Encoding encoding = Encoding::srgb8;
};

/// A moment that surfaces are drawn of instead of the session's own.
struct Moment {
    SceneSnapshot scene;
    Camera camera;
};

/// Seconds that the steps of the last picture took.
struct Timing {
    double context = 0;  ///< making the GL context; 0 when it was there
    double images = 0;   ///< reading the environment and the images that the settings name
    double draw = 0;     ///< auto parameters, upload and all frames
    double read = 0;     ///< reading the picture back
};

/// May be used from any thread, by one at a time; load_environment() alone may run beside context_info().
/// The GL context is made at the first picture.
class Session {
  public:
    explicit Session(Scene scene = {}) : scene_(std::move(scene)) {}

    Scene& scene() { return scene_; }
    const Scene& scene() const { return scene_; }
    Settings& settings() { return settings_; }
    const Settings& settings() const { return settings_; }

    /// Takes settings over as they are, latched values included.
    void replace_settings(const Settings& settings);

    /// Draws the scene and returns RGBA, row 0 on top; in tiles where the picture is too large to be drawn at
    /// once. What was automatic is latched in settings(). Throws ArgumentError (among others when the picture
    /// has more than max_picture_pixels), FileError (images that the settings name), ContextError.
    Image render(const PictureOptions& options = {});

    /// A picture on its way to memory.
    struct Pending {
        Image picture;        ///< as it is drawn; filled by `pixels`, where that is pending
        gl::Readback pixels;  ///< may be handed to the next render_later(), which uses its memory
        std::shared_ptr<const LensMap> lens;
        Annotation annotation;
        AnnotationSettings annotation_settings;
    };
    /// render() that waits for nothing: finish() has the picture, bit for bit, whatever is drawn meanwhile.
    /// What is drawn in tiles is read at once. Throws as render() does.
    Pending render_later(const PictureOptions& options = {}, gl::Readback memory = {});
    /// Whether finish() would not have to wait for the driver.
    bool is_read(const Pending& pending);
    Image finish(Pending& pending);

    /// The same scene, camera and size in exact values through the pixels' centres (no anti-aliasing).
    std::map<std::string, Image> render_layers(const std::vector<std::string>& names,
                                               std::optional<Vec2i> size = std::nullopt);

    /// What the pixels' centres see, as it is drawn: of a warped camera a wider picture, see lens(). With
    /// `picture` the picture that the options ask for is drawn in the same go; drawn_picture() reads it.
    /// `moment` is drawn in place of the session's scene and camera (no picture then).
    render::SurfaceFrame draw_surfaces(const PictureOptions& options, bool picture,
                                       const Moment* moment = nullptr);
    /// The same without reading anything: renderer() has the targets.
    void draw_centres(const PictureOptions& options, bool picture, const Moment* moment = nullptr);
    /// A legend or colour bar belongs to the picture drawn last, and is drawn into it as it is read.
    bool is_annotated() const { return !annotation_.empty(); }
    /// From the pixels of the picture drawn last to what was drawn.
    const LensMap& lens() const { return *lens_; }
    /// The picture of the last draw_surfaces().
    Image drawn_picture();
    /// A layer of the last draw_surfaces(), as it was drawn.
    Image drawn_layer(render::Layer layer);
    /// See render::Renderer::coverage(); of the last draw_surfaces().
    std::vector<uint8_t> coverage(const render::PixelRect& area,
                                  const std::function<bool(size_t object, int first_face)>& wanted);
    /// The scene as it is now and the camera of the next picture.
    Moment moment(std::optional<Vec2i> size = std::nullopt);

    /// Focuses on what a pixel shows, (0, 0) the upper left one of a picture of this size:
    /// settings().depth_of_field.focus_distance is pinned to its depth, which is returned; the rest stays as
    /// it is. Throws ArgumentError when the pixel is outside of the picture or shows nothing.
    double focus_at(int x, int y, std::optional<Vec2i> size = std::nullopt);

    /// With motion_blur.enabled a picture of several samples shows how things moved since the picture before.
    /// After this the next one shows none: nothing is known of before.
    void forget_motion() { motion_.reset(); }
    /// The next picture's motion begins where things are now, as if they had been drawn from this camera;
    /// none: from where the picture's own is.
    void begin_motion(const std::optional<Camera>& from = std::nullopt) {
        motion_begin_.emplace(scene_.snapshot(), from);
    }

    /// Names of what is visible; the layer "object_id" holds 1 + the place in this list.
    std::vector<std::string> object_names() const;

    /// Draws one frame without reading the picture back, but for its first pixel, which makes the driver
    /// finish: for measuring.
    void draw_frame(const PictureOptions& options = {});

    /// A picture that gets better with every call: one more frame of draw_frame()'s, whose picture it is, bit
    /// for bit, after the last. Begins anew when anything that is drawn has changed, or when something else
    /// was drawn meanwhile; does nothing when all frames are there. Without `finish`, the frame is added but
    /// the picture stays as it was. What it shows of motion is `motion`, not what was drawn before; another
    /// object begins anew.
    using RefinedMotion = std::shared_ptr<const Motion>;
    struct Refinement {
        int frames = 0, total = 0;
        bool began = false;  ///< with this call
        bool drew = false;   ///< in this call
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
    /// Pins the camera, as set_camera(), and keeps its target; an automatic near plane comes as near as the
    /// camera.
    void set_view_point(const ViewPoint& view);

    /// Draws a pass of the program's own in every picture from now on; one of the same name is replaced. See
    /// render/custom_pass.h.
    void add_pass(const std::string& name, render::Stage stage, std::shared_ptr<render::Pass> pass);
    /// Throws NameError when there is none of this name.
    void remove_pass(const std::string& name);

    /// The context and the renderer, made when there are none yet: to draw on from the picture.
    gl::Context& context();
    render::Renderer& renderer();

    /// The picture that was drawn last, read back. Throws ArgumentError when there is none.
    Image last_picture();

    /// Everything that the next picture would be drawn with. Nothing is latched.
    ResolvedSettings resolve(std::optional<Vec2i> size = std::nullopt);

    /// Lights the scene with a file: settings().environment.file, read at once. Throws FileError,
    /// FormatError.
    void load_environment(const std::filesystem::path& path);

    /// Pins the camera to a pose: settings().camera follows. A near plane that was inferred is inferred anew.
    void set_camera(const Camera& camera);
    /// The camera of the next picture.
    Camera camera() { return resolve().camera; }

    /// Forgets what was inferred, so that the next picture infers it anew.
    void refit() {
        release(settings_);
        scene_.release_light_radii();
    }

    /// What the GL context is; makes it when there is none yet.
    const gl::ContextInfo& context_info();

    /// From which size on render() and render_layers() draw in tiles; without this what the context can draw.
    void limit_tiles(const render::TileLimits& limits) { tile_limits_ = limits; }

    const Timing& timing() const { return timing_; }

    /// See render::Renderer: false leaves all triangles to the driver.
    void allow_native_geometry(bool allow) { renderer().allow_native_geometry(allow); }

    /// See render::Renderer. 0 before the first picture.
    uint64_t shadow_maps_drawn() const { return renderer_ ? renderer_->shadow_maps_drawn() : 0; }

    /// Milliseconds of each pass of a frame that draw_frame() draws now, each pass finished before the next
    /// begins.
    std::vector<std::pair<std::string, double>> measure_passes(const PictureOptions& options = {});

  private:
    struct Prepared {
        SceneSnapshot scene;
        ResolvedSettings resolved;
        render::DrawOptions options;
        std::vector<std::pair<const render::Pass*, uint64_t>> passes = {};  ///< with their revisions
    };
    /// Snapshot, images, auto parameters.
    Prepared prepare(const PictureOptions& options);
    void load_images();
    /// Reads the files that are new or have changed, all at once.
    void read_images(const std::vector<std::string>& paths);
    std::shared_ptr<const Image> image(const std::string& path);
    SceneSnapshot snapshot();
    /// Reads the files of shaders that are new or have changed.
    void load_shaders(const SceneSnapshot& scene);
    const std::string& shader_text(const std::string& path);
    /// The renderer's picture with its annotation.
    Image read_annotated();
    /// draw_frame(), but that the driver may still be busy with it.
    void begin_frame(const PictureOptions& options);
    TiledPicture tiled(const Prepared& prepared) const;
    /// What the last picture is annotated with.
    void annotate(const Prepared& prepared);
    /// Keeps what was inferred, unless there was nothing to infer it from.
    void latch_from(const Prepared& prepared);
    /// Says when a material has a shader and nothing that it could act on.
    void warn_of_shaders(const SceneSnapshot& scene);
    /// Says when surfels are asked for and a mesh has no normals to make them from: it is drawn as points.
    void warn_of_surfels(const SceneSnapshot& scene);
    Vec2i size_or(std::optional<Vec2i> size) const { return size.value_or(settings_.image.size); }

    Scene scene_;
    Settings settings_;
    Timing timing_;
    bool warned_of_lens_ = false, warned_of_surfels_ = false, warned_of_shaders_ = false;
    std::shared_ptr<const Motion> motion_;  ///< where things were in the picture that was drawn last
    std::optional<std::pair<SceneSnapshot, std::optional<Camera>>> motion_begin_;

    /// What refine() adds frames to; nothing: it has to begin.
    struct Refined {
        Prepared prepared;
        render::SettingsImages images;
        int frames = 0;
        bool is_of(const Prepared& other, const render::SettingsImages& other_images) const;
    };
    std::unique_ptr<Refined> refined_;
    std::unique_ptr<Refined> versioned_;  ///< what picture_version() saw last
    uint64_t version_ = 0;

    /// Replaces a camera that is warped, and the size, by what has to be drawn.
    void apply_lens(Prepared& prepared);
    std::shared_ptr<const LensMap> lens_ = std::make_shared<const LensMap>();
    std::vector<double> lens_key_;

    Annotation annotation_;  ///< of the picture that was drawn last
    AnnotationSettings annotation_settings_;

    std::optional<render::TileLimits> tile_limits_;
    Image tiled_;  ///< the picture that was drawn last, where it was drawn in tiles

    std::unique_ptr<gl::Context> context_;
    std::unique_ptr<render::Renderer> renderer_;

    /// Images that the settings name, by path; read again when the file has changed.
    struct LoadedImage {
        std::filesystem::file_time_type time;
        std::shared_ptr<const Image> image;
    };
    std::map<std::string, LoadedImage> images_;
    std::string environment_file_;
    std::optional<std::string> environment_hash_;  ///< what was latched belongs to this environment
    Environment environment_;
    render::SettingsImages settings_images_;
    /// Files of shaders by path.
    struct ShaderFile {
        std::filesystem::file_time_type time;
        std::string text;
    };
    std::map<std::string, ShaderFile> shader_files_;
    std::vector<render::CustomPass> passes_;
};

}  // namespace easypbr::app
