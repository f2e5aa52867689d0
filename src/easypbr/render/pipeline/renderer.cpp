#include "easypbr/render/pipeline/renderer.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/step_progress.h"
#include "easypbr/core/stopwatch.h"
#include "easypbr/gl/pace.h"
#include "easypbr/render/pipeline/frame_times.h"
#include "easypbr/render/pipeline/kept_surfaces.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

PixelType pixel_type(gl::Format format) {
    return format == gl::Format::rgba8    ? PixelType::u8
           : format == gl::Format::rgba16 ? PixelType::u16
                                          : PixelType::f32;
}

/// The variance of fewer says too little.
constexpr int least_frames_for_noise = 4;

/// Something is seen through it, or it is drawn at random: another frame than the one through the pixels'
/// centres shows what is there.
bool shows_more(const DrawItem& item) {
    return item.layered || item.alpha == AlphaMode::blend;
}

/// Puts the objects where they are at a time between the picture before (0) and this one (1).
void move_objects(DrawableScene& drawable, const SceneSnapshot& scene,
                  const std::vector<Eigen::Affine3d>& before, double time) {
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const Eigen::Affine3d& now = scene.objects[i].T_world_mesh;
        const bool moved = before[i].matrix() != now.matrix() && time < 1;
        drawable.scene.objects[i].T_world_mesh = moved ? between(before[i], now, time) : now;
    }
}

}  // namespace

/// A picture that frames are added to. The lists point into the scene, so it stays where it is.
struct Renderer::Picture {
    Picture(const SceneSnapshot& scene_, const ResolvedSettings& resolved_, const DrawOptions& options_,
            const SettingsImages& images_)
        : scene(scene_), resolved(resolved_), options(options_), images(images_) {}
    Picture(const Picture&) = delete;
    Picture& operator=(const Picture&) = delete;

    const SceneSnapshot scene;
    const ResolvedSettings resolved;
    const DrawOptions options;
    const SettingsImages images;
    DrawableScene drawable;
    DrawList list;      ///< everything
    DrawList averaged;  ///< of frames that are added up
    DrawList casters;   ///< of everything
    Shot shot;
    std::vector<Eigen::Affine3d> poses_before;  ///< of the objects, where the shot has motion
    FrameContents contents;
    Frame frame;                   ///< drawn last
    LitPicture lit;                ///< of that frame
    int frames = 0;                ///< so far
    FrameTimes times;              ///< of those
    bool with_exact = false;       ///< colours of tables, which nothing may mix with others
    bool averages_layers = false;  ///< before those colours
    bool ends_tiles = false;       ///< each once its light is good enough
    bool is_finished = false;      ///< at least once
    bool holds_surfaces = false;   ///< its only frame is what the pixels' centres see
};

namespace {

/// Without motion, through a pinhole.
Shot shot_of(const DrawableScene& drawable, const ResolvedSettings& resolved, const DrawOptions& options) {
    return {.scene = &drawable.scene,
            .resolved = &resolved,
            .size = options.size,
            .picture_size = options.picture_size.isZero() ? options.size : options.picture_size,
            .origin = options.origin,
            .reach = options.reach,
            .sample_count = options.samples};
}

}  // namespace

Renderer::Renderer() {
    const char* native = std::getenv("EASYPBR_NATIVE");
    if (!native || std::strcmp(native, "0") != 0) return;
    allow_native_geometry(false);
    allow_native_shading(false);
}
Renderer::~Renderer() = default;

void Renderer::draw(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
                    const SettingsImages& images) {
    if (options.layers) return draw_layers(scene, resolved, options, images);
    begin(scene, resolved, options, images);
    gl::Pace pace;
    StepProgress progress("picture", "sample", options.samples);
    for (int samples = add_sample(); !is_complete(); samples = add_sample()) {
        pace.step();
        progress.done(samples);
    }
    finish();
}

void Renderer::begin(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
                     const SettingsImages& images) {
    if (options.samples < 1)
        throw ArgumentError(fmt::format("samples: expected 1 or more, got {}", options.samples));
    picture_.reset();
    kept_.reset();
    exact_pixels_ = Image();
    has_layers_ = false;
    pipeline_.begin(options.size);
    camera_ = resolved.camera;
    const bool has_image = resolved.settings.background.mode == BackgroundMode::image;
    output_.begin(options.size, options.encoding, options.without_image && has_image);
    pipeline_.prepare_environment(resolved);
    picture_ = std::make_unique<Picture>(scene, resolved, options, images);
    try {
        prepare(*picture_);
    } catch (...) {
        picture_.reset();
        throw;
    }
}

void Renderer::prepare(Picture& picture) {
    const DrawOptions& options = picture.options;
    const ResolvedSettings& resolved = picture.resolved;
    picture.drawable = drawables_.apply(picture.scene, resolved.settings);
    sources_ = picture.drawable.sources;
    const DrawList all =
        draw_list(picture.drawable, resolved.settings, picture.images.textures, picture.images.shader_files);
    const bool is_picture = !options.ids;
    picture.list = is_picture ? all : all.as_surfaces();
    picture.casters = picture.list.as_casters(resolved.settings.splats.cast);
    const bool accumulated = options.samples > 1;
    picture.shot = shot_of(picture.drawable, picture.resolved, options);
    picture.shot.motion = accumulated ? options.motion.get() : nullptr;
    if (picture.shot.motion) picture.poses_before = picture.shot.motion->poses_before(picture.scene);
    picture.shot.through_lens = accumulated && resolved.lens_radius > 0;
    if (options.surfaces) {
        keep_surfaces(picture.scene, resolved, options.size, picture.images);
        picture.holds_surfaces = options.samples == 1 && !all.has(shows_more) && !all.has_soft_surfaces() &&
                                 !all.extensions() && !GroundPass::is_on(resolved) &&
                                 !all.has([](const DrawItem& item) { return draws_discs(item.style.mode); });
    }
    const bool traces_paths = resolved.traces_paths && (options.samples > 1 || resolved.asks_for_paths);
    picture.contents = {.ids = options.ids || picture.holds_surfaces,
                        .ground = GroundPass::is_on(resolved) && is_picture,
                        .traced = resolved.traces_rays || traces_paths,
                        .paths = traces_paths && is_picture,
                        .custom = is_picture ? &custom_ : nullptr};
    picture.shot.averages_radiance = picture.contents.paths;
    const ImageSettings& image = resolved.settings.image;
    picture.shot.may_end_early = image.time_budget > 0 || (image.noise > 0 && picture.contents.paths);
    if (picture.contents.paths) picture.list = picture.list.as_first_hits();
    picture.with_exact = picture.list.has(
        [](const DrawItem& item) { return item.kind == SurfaceKind::exact && !item.layered; });
    picture.contents.in_host_memory = is_picture;
    // What is exact is drawn once, through the pixels' centres: the frames that are averaged go without.
    const bool apart = options.samples > 1 && picture.with_exact;
    picture.averaged = apart ? picture.list.without_exact() : picture.list;
    picture.averages_layers = apart && picture.contents.paths && picture.list.has(&DrawItem::layered);
    if (picture.contents.ids) pipeline_.targets().add_ids();
    // Where tiles do not depend on each other.
    picture.ends_tiles = picture.shot.averages_radiance && custom_.empty() &&
                         !pipeline_.spreads_light(picture.shot) && !all.has(&DrawItem::layered);
}

int Renderer::add_sample() {
    Picture& picture = *picture_;
    const Timer timer;
    draw_sample(picture);
    if (picture.averages_layers) draw_layers_before_exact(picture);
    picture.times.add(timer.seconds());
    ++picture.frames;
    return picture.frames;
}

bool Renderer::is_complete() const {
    const Picture& picture = *picture_;
    if (picture.frames >= picture.shot.sample_count) return true;
    const double budget = picture.resolved.settings.image.time_budget * picture.options.time_share;
    if (budget > 0 && !picture.times.has_time(budget)) return true;
    return picture.frames >= least_frames_for_noise && output_.is_good(picture.frame);
}

Frame Renderer::next_frame(const Picture& picture, const Shot& shot, Camera camera, const DrawList& list) {
    const Box3d& bounds = pipeline_.bounds_of(*shot.scene);
    const bool ground = picture.contents.ground;
    if (ground) GroundPass::widen_depth(camera, picture.resolved, bounds);
    return make_frame(shot, picture.frames, camera, bounds, list.reaches_beyond_vertices() || ground);
}

void Renderer::draw_sample(Picture& picture) {
    const Shot& shot = picture.shot;
    if (shot.motion) {
        const double shutter = picture.resolved.settings.motion_blur.shutter;
        move_objects(picture.drawable, picture.scene, picture.poses_before,
                     shutter_time(picture.frames, shot.sample_count, shutter));
    }
    picture.frame = next_frame(picture, shot, camera_of(shot, picture.frames), picture.averaged);
    has_layers_ = true;
    picture.lit = pipeline_.draw(picture.frame, picture.averaged, picture.casters, picture.contents);
    if (shot.sample_count == 1 && !shot.averages_radiance) return;
    pipeline_.timer().run("accumulate", [&] {
        output_.accumulate(picture.frame, picture.lit, pipeline_.targets());
        if (shot.averages_radiance) release_radiance();
        if (!picture.ends_tiles) return;
        output_.end_tiles(picture.frame);
        picture.contents.tiles = &output_.tiles();
    });
}

void Renderer::draw_layers_before_exact(Picture& picture) {
    if (picture.shot.motion) move_objects(picture.drawable, picture.scene, picture.poses_before, 1);
    Shot shot = picture.shot;
    shot.through_lens = false;
    shot.through_centres = true;
    FrameContents contents = picture.contents;
    contents.only_layers = true;
    const Frame frame = next_frame(picture, shot, picture.resolved.camera, picture.list);
    const LitPicture lit = pipeline_.draw(frame, picture.list, picture.casters, contents);
    pipeline_.timer().run("accumulate", [&] {
        output_.accumulate_layers(frame, lit, pipeline_.targets());
        release_radiance();
    });
}

void Renderer::release_radiance() {
    if (custom_.empty()) pipeline_.targets().radiance.release();
}

void Renderer::finish() {
    Picture& picture = *picture_;
    const bool is_last = is_complete();
    PassTimer& timer = pipeline_.timer();
    const GBuffer* exact = picture.with_exact ? &pipeline_.targets() : nullptr;
    if (is_last && picture.shot.averages_radiance) {
        pipeline_.end_paths();
        if (custom_.empty() && !exact && !picture.holds_surfaces) release_targets();
    }
    const LitPicture shown = timer.run("output", [&] {
        BackgroundImage* background =
            picture.options.without_image ? nullptr : background_image(picture.resolved, picture.images);
        return output_.finish(picture.frame, picture.lit, background, pipeline_.targets(), exact);
    });
    if (picture.shot.motion) move_objects(picture.drawable, picture.scene, picture.poses_before, 1);
    if (exact) timer.run("exact", [&] { draw_exact(shown); });
    if (exact && picture.options.exact_pixels)
        exact_pixels_ = mask_of_kind(SurfaceKind::exact, pipeline_.targets(), pipeline_.transfers());
    if (picture.contents.custom) draw_custom_over_picture();
    if (is_last && picture.options.surfaces && !picture.holds_surfaces)
        timer.run("surfaces", [&] { draw_kept(); });
    // Once a picture: frames after the first ask for less than the first did.
    if (!std::exchange(picture.is_finished, true)) evict_unused();
    if (is_last) picture_.reset();
    gl::flush();
}

void Renderer::release_targets() {
    pipeline_.targets().release();
    has_layers_ = false;
}

void Renderer::draw_exact(const LitPicture& shown) {
    Picture& picture = *picture_;
    const bool has_layers = picture.list.has(&DrawItem::layered);
    const bool averaged = picture.shot.sample_count > 1;
    // The only frame is that of the pixels' centres.
    if (has_layers && picture.shot.averages_radiance) {
        const LitPicture lit = averaged ? output_.layers_mean(picture.frame) : shown;
        return output_.write_exact(picture.frame, lit, pipeline_.targets(), true);
    }
    LitPicture lit = shown;
    Frame frame = picture.frame;
    if (averaged) {
        Shot shot = picture.shot;
        shot.motion = nullptr;
        shot.through_lens = false;
        shot.sample_count = 1;
        Camera camera = picture.resolved.camera;
        const Box3d& bounds = pipeline_.bounds_of(*shot.scene);
        const bool with_ground = has_layers && picture.contents.ground;
        if (with_ground) GroundPass::widen_depth(camera, picture.resolved, bounds);
        frame = make_frame(shot, 0, camera, bounds, picture.list.reaches_beyond_vertices() || with_ground);
    }
    // What lies before exact colours is lit and mixed with them in a whole frame.
    if (averaged && has_layers) {
        FrameContents contents = picture.contents;
        contents.traced = picture.resolved.traces_single_frames;
        lit = pipeline_.draw(frame, picture.list, picture.casters, contents);
        lit.partly_covered |= shown.partly_covered;
    }
    if (averaged && !has_layers) {
        pipeline_.draw_surfaces(frame, picture.list, {.ids = picture.contents.ids});
        if (!output_.is_finished_natively()) pipeline_.targets().upload(pipeline_.transfers());
    }
    if (!has_layers)
        lit.overlay =
            pipeline_.draw_overlay(frame, picture.list, picture.contents, output_.is_finished_natively());
    // Effects spread no light over exact colours.
    lit.radiance = &pipeline_.targets().radiance;
    output_.write_exact(frame, lit, pipeline_.targets(), has_layers);
}

void Renderer::draw_layers(const SceneSnapshot& scene, const ResolvedSettings& resolved,
                           const DrawOptions& options, const SettingsImages& images) {
    picture_.reset();
    kept_.reset();
    pipeline_.begin(options.size);
    camera_ = resolved.camera;
    if (options.surfaces) keep_surfaces(scene, resolved, options.size, images);
    const DrawableScene drawable = drawables_.apply(scene, resolved.settings);
    sources_ = drawable.sources;
    const DrawList list =
        draw_list(drawable, resolved.settings, images.textures, images.shader_files).as_surfaces();
    Shot shot = shot_of(drawable, resolved, options);
    shot.sample_count = 1;
    const Frame frame = make_frame(shot, 0, resolved.camera, pipeline_.bounds_of(drawable.scene),
                                   list.reaches_beyond_vertices());
    // Layers are of the nearest disc, as ground truth is. Light is occluded as in pictures: by the mean of
    // those that overlap.
    const bool has_discs = list.has([](const DrawItem& item) { return draws_discs(item.style.mode); });
    const bool occludes = options.occlusion && resolved.settings.ssao.enabled;
    if (!occludes) pipeline_.targets().remove_ambient_occlusion();
    if (occludes && has_discs) {
        pipeline_.draw_surfaces(frame, list, {});
        pipeline_.occlude_surfaces(frame, list);
    }
    const bool ids = options.ids || options.surfaces || has_discs;
    pipeline_.draw_surfaces(frame, list, {.ids = ids, .nearest_alone = true});
    if (occludes && !has_discs) pipeline_.occlude_surfaces(frame, list);
    has_layers_ = true;
    evict_unused();
    gl::flush();
}

void Renderer::draw_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                             const SettingsImages& images) {
    picture_.reset();
    pipeline_.begin(size);
    camera_ = resolved.camera;
    keep_surfaces(scene, resolved, size, images);
    draw_kept();
    evict_unused();
    gl::flush();
}

void Renderer::keep_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                             const SettingsImages& images) {
    kept_ = std::make_unique<KeptSurfaces>(scene, drawables_.apply(scene, resolved.settings), resolved, size,
                                           images.textures, images.shader_files);
    sources_ = kept_->sources();
}

void Renderer::draw_kept() {
    kept_->draw(pipeline_);
    has_layers_ = true;
}

void Renderer::evict_unused() {
    pipeline_.evict_unused();
    drawables_.evict_unused();
}

BackgroundImage* Renderer::background_image(const ResolvedSettings& resolved, const SettingsImages& images) {
    const BackgroundSettings& background = resolved.settings.background;
    if (background.mode != BackgroundMode::image || !images.background) return nullptr;
    if (!background_ || background_->image() != images.background)
        background_ = std::make_unique<BackgroundImage>(
            images.background, background.image.empty() ? "array" : background.image.name());
    return background_.get();
}

void Renderer::draw_custom_over_picture() {
    if (!has_custom(picture_->contents.custom, Stage::picture)) return;
    custom_.draw(Stage::picture, picture_->frame, pipeline_.targets(), output_.drawn(), pipeline_.timer());
}

Image Renderer::read_picture() const {
    return read_picture(output_.picture().width(), output_.picture().height());
}

Image Renderer::read_picture(const PixelRect& area) const {
    Image image(area.width, area.height, 4, pixel_type(output_.format()));
    const Target& picture = output_.picture();
    if (picture.is_ahead())
        picture.copy_out(area, image.bytes());
    else
        output_.framebuffer().read(0, output_.format(), area.x, area.y, area.width, area.height,
                                   image.bytes());
    return image;
}

Image Renderer::begin_reading(gl::Readback& readback) const {
    if (output_.picture().is_ahead()) return read_picture();
    const gl::Framebuffer& from = output_.framebuffer();
    readback.begin(from, 0, output_.format(), 0, 0, from.width(), from.height());
    return {from.width(), from.height(), 4, pixel_type(output_.format())};
}

Image Renderer::read_layer(Layer layer) const {
    if (!has_layers_) throw ArgumentError("read_layer: the last picture was drawn without surfaces");
    return render::read_layer(layer, pipeline_.targets(), camera_, sources_, pipeline_.transfers());
}

SurfaceFrame Renderer::read_surfaces() const {
    if (!kept_) throw ArgumentError("read_surfaces: the last picture was drawn without surfaces");
    return kept_->read(pipeline_.targets(), pipeline_.transfers());
}

std::vector<uint8_t> Renderer::coverage(const PixelRect& area,
                                        const std::function<bool(size_t, int)>& wanted) {
    if (!kept_) throw ArgumentError("coverage: the last picture was drawn without surfaces");
    return kept_->coverage(pipeline_, area, wanted);
}

std::vector<ScreenReach> Renderer::reaches() {
    if (!kept_) throw ArgumentError("reaches: the last picture was drawn without surfaces");
    return kept_->reaches(pipeline_);
}

const std::vector<bool>& Renderer::blended() const {
    if (!kept_) throw ArgumentError("blended: the last picture was drawn without surfaces");
    return kept_->blended();
}

}  // namespace easypbr::render
