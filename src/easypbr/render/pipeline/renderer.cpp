#include "easypbr/render/pipeline/renderer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/gl/context.h"

namespace easypbr::render {
namespace {

std::optional<RayGround> ray_ground(const Frame& frame) {
    if (!frame.with_ground) return std::nullopt;
    const GroundSettings& ground = frame.resolved->settings.ground;
    return RayGround{.up = parse_up(frame.resolved->settings.camera.up),
                     .height = *ground.height,
                     .radius = double(*ground.radius),
                     .color = linear_from_srgb(ground.color),
                     .roughness = ground.roughness,
                     .shadow_catcher = GroundPass::is_shadow_catcher(*frame.resolved)};
}

}  // namespace

template <class Pass>
void Renderer::run(const char* name, Pass&& pass) {
    // What a pass runs within itself counts as its own.
    if (!measure_ || running_) return pass();
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    running_ = true;
    pass();
    running_ = false;
    glFinish();
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const auto found =
        std::find_if(pass_times_.begin(), pass_times_.end(), [&](const auto& p) { return p.first == name; });
    if (found == pass_times_.end())
        pass_times_.emplace_back(name, ms);
    else
        found->second += ms;
}

Renderer::Renderer() : no_attributes_(gl::VertexArray::make()) {}

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
    Frame frame;
    LitPicture lit;               ///< of the frame drawn last
    bool is_finished = false;     ///< at least once
    bool holds_surfaces = false;  ///< its only frame is what the pixels' centres see
};

Renderer::~Renderer() = default;

void Renderer::draw(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
                    const SettingsImages& images) {
    begin(scene, resolved, options, images);
    while (add_sample() < options.samples) continue;
    finish();
}

void Renderer::prepare_targets(Vec2i size, const ResolvedSettings& resolved) {
    // Row 0 of every target is the top of the picture; depth runs from 1 (near) to 0 (infinitely far).
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    if (!targets_.albedo || targets_.size() != size) targets_ = GBuffer(size);
    if (!*resolved.settings.ssao.enabled) targets_.remove_ambient_occlusion();
    pass_times_.clear();
    running_ = false;
    camera_ = resolved.camera;
}

void Renderer::begin(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
                     const SettingsImages& images) {
    if (options.samples < 1)
        throw ArgumentError(fmt::format("samples: expected 1 or more, got {}", options.samples));
    picture_.reset();
    drawn_.reset();
    prepare_targets(options.size, resolved);
    output_.begin(options.size, options.encoding);
    if (!resolved.environment.empty())
        run("environment", [&] {
            const bool seen = resolved.settings.background.shows_environment();
            environment_.prepare(resolved.environment, seen ? resolved.seen_environment : Environment());
        });
    auto picture = std::make_unique<Picture>(scene, resolved, options, images);
    picture->drawable = drawables_.apply(picture->scene, resolved.settings);
    element_sources_ = picture->drawable.sources;
    const DrawList all =
        draw_list(picture->drawable, resolved.settings, images.textures, images.shader_files);
    picture->list = options.layers || options.ids ? all.as_surfaces() : all;
    Frame& frame = picture->frame;
    frame.scene = &picture->drawable.scene;
    frame.resolved = &picture->resolved;
    frame.size = options.size;
    frame.picture_size = options.picture_size.isZero() ? options.size : options.picture_size;
    frame.origin = options.origin;
    frame.reach = options.reach;
    frame.sample_count = options.samples;
    const bool still = options.samples > 1 && !options.layers;
    frame.motion = still ? options.motion.get() : nullptr;
    frame.through_lens = still && resolved.lens_radius > 0;
    frame.spreads = resolved.settings.bloom.enabled || resolved.lens_radius > 0;
    frame.sample_index = -1;
    frame.with_ids = options.ids;
    if (options.surfaces) {
        keep_surfaces(scene, resolved, options.size, images);
        const auto sees_more = [](const DrawItem& item) {
            return item.layered || item.alpha == AlphaMode::blend;
        };
        picture->holds_surfaces =
            options.samples == 1 && !all.has(sees_more) && !all.extensions() && !GroundPass::is_on(resolved);
        frame.with_ids |= picture->holds_surfaces;
    }
    frame.with_exact = picture->list.has(
        [](const DrawItem& item) { return item.kind == SurfaceKind::exact && !item.layered; });
    // What is exact is drawn once, through the pixels' centres: the frames that are averaged go without.
    const bool apart = options.samples > 1 && frame.with_exact;
    picture->averaged = apart ? picture->list.without_exact() : picture->list;
    // What a pass draws may be anywhere.
    frame.spreads |= has_custom(Stage::light) || has_custom(Stage::overlay);
    // Layers are of the content.
    frame.with_ground = GroundPass::is_on(resolved) && !options.layers && !options.ids;
    if (frame.with_ids) targets_.add_ids();
    picture_ = std::move(picture);
}

int Renderer::add_sample() {
    Frame& frame = picture_->frame;
    ++frame.sample_index;
    frame.time =
        shutter_time(frame.sample_index, frame.sample_count, picture_->resolved.settings.motion_blur.shutter);
    if (frame.motion) move_objects(picture_->drawable, picture_->scene, *frame.motion, frame.time);
    draw_frame(frame, picture_->averaged, picture_->list);
    picture_->lit = picture_->options.layers ? LitPicture{&targets_.radiance} : post_process(frame);
    if (frame.sample_count > 1) run("accumulate", [&] { output_.accumulate(frame, picture_->lit); });
    return frame.sample_index + 1;
}

void Renderer::finish() {
    const Frame& frame = picture_->frame;
    run("output",
        [&] { output_.finish(frame, picture_->lit, targets_, background_texture(frame, picture_->images)); });
    if (frame.motion) move_objects(picture_->drawable, picture_->scene, *frame.motion, 1);
    if (frame.with_exact) {
        Frame exact = frame;
        exact.motion = nullptr;
        exact.through_lens = false;
        run("exact", [&] { draw_exact(exact, picture_->list); });
    }
    run_custom(Stage::picture, frame);
    const bool is_last = frame.sample_index + 1 == frame.sample_count;
    if (is_last && picture_->options.surfaces && !picture_->holds_surfaces)
        run("surfaces", [&] { draw_kept_surfaces(); });
    // Once a picture: frames after the first ask for less than the first did.
    if (!std::exchange(picture_->is_finished, true)) evict_unused();
    if (is_last) picture_.reset();
    glFlush();
}

void Renderer::draw_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                             const SettingsImages& images) {
    picture_.reset();
    prepare_targets(size, resolved);
    keep_surfaces(scene, resolved, size, images);
    draw_kept_surfaces();
    evict_unused();
    glFlush();
}

void Renderer::keep_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                             const SettingsImages& images) {
    drawn_ =
        std::make_unique<Drawn>(Drawn{drawables_.apply(scene, resolved.settings), resolved, scene, {}, size});
    element_sources_ = drawn_->drawable.sources;
    drawn_->surfaces =
        draw_list(drawn_->drawable, resolved.settings, images.textures, images.shader_files).as_surfaces();
}

void Renderer::draw_kept_surfaces() {
    targets_.add_ids();
    Frame frame;
    frame.scene = &drawn_->drawable.scene;
    frame.resolved = &drawn_->resolved;
    frame.size = frame.picture_size = drawn_->size;
    frame.with_ids = true;
    frame.camera = drawn_->resolved.camera;
    prepare_frame(frame, bounds_of(*frame.scene), drawn_->surfaces.reaches_beyond_vertices());
    draw_geometry(frame, drawn_->surfaces);
    no_attributes_.bind();
}

void Renderer::evict_unused() {
    meshes_.evict_unused();
    textures_.evict_unused();
    software_geometry_.evict_unused();
    closed_meshes_.evict_unused();
    point_buffers_.evict_unused();
    surfel_buffers_.evict_unused();
    spacings_.evict_unused();
    drawables_.evict_unused();
    lines_.evict_unused();
}

void Renderer::move_objects(DrawableScene& drawable, const SceneSnapshot& scene, const Motion& motion,
                            double time) {
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneSnapshot::Object& object = scene.objects[i];
        const auto before = motion.poses.find(object.name);
        // What was not there before does not move.
        const bool moved = before != motion.poses.end() &&
                           before->second.matrix() != object.T_world_mesh.matrix() && time < 1;
        drawable.scene.objects[i].T_world_mesh =
            moved ? between(before->second, object.T_world_mesh, time) : object.T_world_mesh;
    }
}

LitPicture Renderer::post_process(Frame& frame) {
    LitPicture lit{&targets_.radiance, frame.with_overlay ? &targets_.overlay : nullptr};
    no_attributes_.bind();
    if (frame.resolved->lens_radius > 0 && !frame.through_lens) {
        run("depth of field", [&] { focus_.draw(frame, targets_, bounds_of(*frame.scene)); });
        lit.radiance = &focus_.radiance();
        frame.partly_covered = true;
    }
    if (!frame.resolved->settings.bloom.enabled) return lit;
    run("bloom", [&] { bloom_.draw(frame, *lit.radiance); });
    lit.glow = &bloom_.glow();
    frame.partly_covered = true;  // Light falls where nothing is.
    return lit;
}

const Box3d& Renderer::bounds_of(const SceneSnapshot& scene) {
    std::vector<std::pair<uint64_t, Eigen::Affine3d>> key;
    for (const auto& object : scene.objects) key.emplace_back(object.mesh->V.revision(), object.T_world_mesh);
    const auto same = [](const auto& a, const auto& b) {
        return a.first == b.first && a.second.matrix() == b.second.matrix();
    };
    if (!std::ranges::equal(key, bounded_, same)) {
        bounds_ = scene.bounds();
        bounded_ = std::move(key);
    }
    return bounds_;
}

void Renderer::draw_geometry(Frame& frame, const DrawList& list, const GBuffer& targets) {
    const bool native = native_geometry_ && gl::Context::current().info().software;
    if (!native || !SoftwareGeometryPass::handles(list) || !software_geometry_.draw(frame, list, targets)) {
        geometry_.draw(frame, list.meshes, targets);
        if (native && !list.points.empty() && SoftwareGeometryPass::handles_points(list))
            software_geometry_.draw_points_over(frame, list, targets);
        else
            points_.draw(frame, list.points, targets);
    }
    surfels_.draw(frame, list.surfels, targets, native);
    const int fillings = frame.resolved->settings.points.hole_filling;
    no_attributes_.bind();
    if (fillings > 0 && !list.points.empty()) composite_.fill_holes(frame, targets, fillings);
}

void Renderer::draw_geometry(Frame& frame, const DrawList& list) {
    if (!list.has(is_over)) return draw_geometry(frame, list, targets_);
    const PixelRect everything = frame.covered;
    draw_geometry(frame, list.without(is_over), targets_);
    frame.covered = everything;
    if (!over_.albedo || over_.size() != frame.size) over_ = GBuffer(frame.size);
    if (frame.with_ids) over_.add_ids();
    if (frame.extensions) over_.add_extensions();
    draw_geometry(frame, list.without(std::not_fn(is_over)), over_);
    frame.covered = everything;
    composite_.draw_over(frame, over_, targets_);
}

void Renderer::draw_frame(Frame& frame, const DrawList& list, const DrawList& casters) {
    const Camera& camera = frame.resolved->camera;
    frame.camera = frame.motion ? between(frame.motion->camera, camera, frame.time) : camera;
    if (frame.with_ground) GroundPass::widen_depth(frame.camera, *frame.resolved, bounds_of(*frame.scene));
    prepare_frame(frame, bounds_of(*frame.scene), list.reaches_beyond_vertices() || frame.with_ground);
    frame.with_overlay = list.needs_overlay() || has_custom(Stage::overlay);
    if (frame.with_overlay) targets_.add_overlay();
    const bool has_layers = list.has([](const DrawItem& item) { return item.layered; });
    const PixelRect everything = frame.covered;
    const DrawList solid = has_layers ? list.without_layers() : DrawList();
    // What is asked for beside the picture is of the core model.
    const bool extensible = !frame.with_ids;
    frame.extensions = extensible ? (has_layers ? solid : list).extensions() : 0;
    if (frame.extensions) targets_.add_extensions();
    run("geometry", [&] { draw_geometry(frame, has_layers ? solid : list); });
    no_attributes_.bind();
    if (frame.with_ground) {
        frame.covered = everything;
        run("ground", [&] { ground_.draw(frame, targets_); });
    }
    const bool traced = traces(frame);
    if (*frame.resolved->settings.ssao.enabled && !traced)
        run("ambient occlusion", [&] { ambient_occlusion_.draw(frame, targets_); });
    const bool received = frame.with_ground || list.has(&DrawItem::receives_shadows);
    shadow_maps_.begin(frame, casters, bounds_of(*frame.scene), received);
    if (traced)
        run("rays", [&] {
            ray_scene_.update(casters, shadow_maps_.caster_bounds(), shadow_maps_.casters_generation(),
                              shadow_maps_.splats(), ray_ground(frame));
        });
    draw_lights(frame, targets_);
    if (frame.with_ground) {
        run("ground", [&] { ground_.finish(frame, targets_, bounds_of(*frame.scene)); });
        frame.partly_covered = true;
    }
    const bool with_environment = !frame.resolved->environment.empty();
    if (frame.with_overlay) run("display", [&] { display_.draw(frame, targets_); });
    if (!has_layers) run("lines", [&] { draw_lines(frame, list); });
    no_attributes_.bind();
    if (with_environment && frame.resolved->settings.background.shows_environment())
        run("background", [&] { background_.draw(frame, targets_, environment_, frame.with_ground); });
    if (has_layers) {
        frame.covered = everything;
        run("transparency", [&] { draw_transparent(frame, list); });
    }
    if (!has_custom(Stage::light) && !has_custom(Stage::overlay)) return;
    frame.covered = {0, 0, frame.size.x(), frame.size.y()};
    frame.partly_covered = true;
    run_custom(Stage::light, frame);
    run_custom(Stage::overlay, frame);
}

bool Renderer::has_custom(Stage stage) const {
    // Layers and surfaces alone are no pictures.
    const bool draws = picture_ && !picture_->options.layers && !picture_->options.ids;
    return draws && std::ranges::any_of(custom_, [&](const CustomPass& c) { return c.stage == stage; });
}

void Renderer::run_custom(Stage stage, const Frame& frame) {
    if (!has_custom(stage)) return;
    const gl::Texture& image = stage == Stage::light     ? targets_.radiance
                               : stage == Stage::overlay ? targets_.overlay
                                                         : output_.texture();
    gl::Framebuffer own;
    if (stage != Stage::picture) own = gl::Framebuffer({&image});
    const PassInput input(frame, targets_, image, stage == Stage::picture ? output_.picture() : own,
                          custom_copies_[size_t(stage)]);
    for (const CustomPass& custom : custom_) {
        if (custom.stage != stage) continue;
        no_attributes_.bind();
        run(custom.name.c_str(), [&] { draw_custom(custom, input); });
    }
    no_attributes_.bind();
}

bool Renderer::traces(const Frame& frame) const {
    // Layers are not lit. A frame of exact colours stands beside the averaged ones, whose rays are spread
    // over all of them: it would have to send as many alone.
    const bool alone = frame.sample_count < picture_->options.samples;
    const bool wanted = !alone || frame.resolved->settings.rays.enabled.value().has_value();
    return frame.resolved->traces_rays && wanted && !picture_->options.layers;
}

void Renderer::draw_lights(Frame& frame, const GBuffer& targets) {
    shadow_maps_.rewind();
    if (traces(frame)) {
        run("rays", [&] { rays_.draw(frame, targets, ray_scene_); });
        frame.traced = &rays_.light();
    }
    const bool shadow_catcher =
        frame.with_ground && &targets == &targets_ && GroundPass::is_shadow_catcher(*frame.resolved);
    if (shadow_catcher) ground_.begin_light(frame, targets);
    LightBlock block;
    bool first = true;
    do {
        run("shadows", [&] { block = shadow_maps_.next_block(); });
        block.first = first;
        no_attributes_.bind();
        const bool with_environment = first && !frame.resolved->environment.empty();
        const gpu::EnvironmentMaps* maps = with_environment ? &environment_ : nullptr;
        run("lighting", [&] { lighting_.draw(frame, targets, block, maps); });
        if (shadow_catcher)
            run("ground", [&] { lighting_.draw_caught(frame, targets, block, maps, ground_.light()); });
        first = false;
    } while (shadow_maps_.has_more());
    frame.traced = nullptr;
}

void Renderer::draw_exact(Frame& frame, const DrawList& list) {
    const bool has_layers = list.has([](const DrawItem& item) { return item.layered; });
    const bool averaged = frame.sample_count > 1;
    frame.sample_index = 0;
    frame.sample_count = 1;
    // What lies before exact colours is lit and mixed with them in a whole frame.
    if (averaged && has_layers) draw_frame(frame, list, list);
    if (averaged && !has_layers) {
        frame.extensions = 0;  // What the averaged frames left: nothing is lit here.
        frame.camera = frame.resolved->camera;
        prepare_frame(frame, bounds_of(*frame.scene), list.reaches_beyond_vertices());
        draw_geometry(frame, list);
    }
    if (!has_layers) {
        frame.with_overlay = !list.lines.empty() || has_custom(Stage::overlay);
        if (frame.with_overlay) {
            const float nothing[4] = {0, 0, 0, 0};
            targets_.display.clear_color(0, nothing);
            draw_lines(frame, list);
            run_custom(Stage::overlay, frame);
        }
    }
    no_attributes_.bind();
    output_.write_exact(frame, targets_, has_layers);
}

const gl::Texture* Renderer::background_texture(const Frame& frame, const SettingsImages& images) {
    if (frame.resolved->settings.background.mode != BackgroundMode::image || !images.background)
        return nullptr;
    if (images.background != background_image_) {
        background_image_ = images.background;
        background_texture_ =
            gpu::make_texture(*background_image_, true, frame.resolved->settings.background.image);
        background_texture_.sampling(gl::Filtering::linear);
    }
    return &background_texture_;
}

}  // namespace easypbr::render
