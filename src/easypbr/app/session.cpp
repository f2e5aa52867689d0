#include "easypbr/app/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "easypbr/app/stopwatch.h"
#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/fields.h"

namespace easypbr::app {
namespace {

void check_size(Vec2i size) {
    if (size.x() < 1 || size.y() < 1 || size.x() > max_image_side || size.y() > max_image_side)
        throw ArgumentError(fmt::format("picture size {}x{}: width and height must be 1 to {}", size.x(),
                                        size.y(), max_image_side));
    if (int64_t(size.x()) * size.y() > max_picture_pixels)
        throw ArgumentError(
            fmt::format("picture size {}x{}: expected {} pixels at most, such as 32768x32768 or 65536x16384",
                        size.x(), size.y(), max_picture_pixels));
}

struct NamedTexture {
    std::string MaterialSettings::*path;
    Texture Material::*texture;
};

/// An automatic near plane stays within this part of the target's distance (auto_camera.cpp begins there).
constexpr double near_part = 1e-3;

constexpr NamedTexture named_textures[] = {
    {&MaterialSettings::base_color_texture, &Material::base_color_texture},
    {&MaterialSettings::metallic_texture, &Material::metallic_texture},
    {&MaterialSettings::roughness_texture, &Material::roughness_texture},
    {&MaterialSettings::normal_texture, &Material::normal_texture},
    {&MaterialSettings::occlusion_texture, &Material::occlusion_texture},
    {&MaterialSettings::emissive_texture, &Material::emissive_texture},
    {&MaterialSettings::opacity_texture, &Material::opacity_texture}};

/// The same data at the same places. Data never change, so those that are the same object are the same.
bool same_scene(const SceneSnapshot& a, const SceneSnapshot& b) {
    const auto same_object = [](const SceneSnapshot::Object& x, const SceneSnapshot::Object& y) {
        return x.mesh == y.mesh && x.name == y.name && x.T_world_mesh.matrix() == y.T_world_mesh.matrix();
    };
    const auto hash = [](const Environment& environment) {
        return environment.empty() ? std::string() : environment.hash();
    };
    return std::ranges::equal(a.objects, b.objects, same_object) && a.origin == b.origin &&
           hash(a.environment) == hash(b.environment);
}

bool same_settings(const Settings& a, const Settings& b) {
    return std::ranges::all_of(fields(), [&](const Field& field) { return field.get(a) == field.get(b); });
}

}  // namespace

render::Renderer& Session::renderer() {
    if (!renderer_) {
        const Stopwatch watch(timing_.context);
        if (!context_) context_ = gl::Context::create();
        const gl::ContextScope scope(*context_);
        renderer_ = std::make_unique<render::Renderer>();
        renderer_->set_passes(passes_);
    }
    return *renderer_;
}

const gl::ContextInfo& Session::context_info() {
    if (!context_) context_ = gl::Context::create();
    return context_->info();
}

std::shared_ptr<const Image> Session::image(const std::string& path) {
    return path.empty() ? nullptr : images_.at(path).image;
}

void Session::read_images(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) images_[path];  // The map must not change while threads use it.
    parallel_for(paths.size(), 1, [&](size_t i) {
        LoadedImage& slot = images_.at(paths[i]);
        std::error_code ignored;  // A file that is missing is reported by load_image().
        const auto time = std::filesystem::last_write_time(paths[i], ignored);
        if (!slot.image || slot.time != time)
            slot = {time, std::make_shared<const Image>(io::load_image(paths[i]))};
    });
}

void Session::load_images() {
    std::set<std::string> paths;
    for (const NamedTexture& named : named_textures) paths.insert(settings_.material.*named.path);
    if (settings_.background.mode == BackgroundMode::image) {
        if (settings_.background.image.empty())
            throw ArgumentError("background.mode is image, but background.image names no file");
        paths.insert(settings_.background.image);
    }
    paths.erase("");
    read_images({paths.begin(), paths.end()});
    settings_images_ = {};
    for (const NamedTexture& named : named_textures) {
        Texture& texture = settings_images_.textures.*named.texture;
        texture.path = settings_.material.*named.path;
        texture.image = image(texture.path);
    }
    if (settings_.background.mode == BackgroundMode::image)
        settings_images_.background = image(settings_.background.image);
    if (settings_.environment.file != environment_file_) {
        const std::filesystem::path file = settings_.environment.file;
        environment_ = file.empty() ? Environment() : Environment(file);
        environment_file_ = settings_.environment.file;
    }
}

SceneSnapshot Session::snapshot() {
    load_images();
    SceneSnapshot scene = scene_.snapshot();
    load_shaders(scene);
    if (!environment_.empty()) scene.environment = environment_;
    const std::string hash = scene.environment.empty() ? "" : scene.environment.hash();
    if (environment_hash_ && hash != *environment_hash_) {
        // Which lights are on and how the picture is exposed follows from the environment: they are inferred
        // anew.
        for (StudioLight* light : {&settings_.lights.key, &settings_.lights.fill, &settings_.lights.rim})
            light->enabled.release();
        settings_.environment.sun.release();
        settings_.tonemap.exposure.release();
    }
    environment_hash_ = hash;
    return scene;
}

ResolvedSettings Session::resolve(std::optional<Vec2i> size) {
    check_size(size_or(size));
    return easypbr::resolve(snapshot(), settings_, size_or(size));
}

Session::Prepared Session::prepare(const PictureOptions& options) {
    timing_ = {};
    Prepared prepared;
    prepared.options.size = size_or(options.size);
    prepared.options.samples = options.samples.value_or(settings_.image.samples);
    prepared.options.encoding = options.encoding;
    check_size(prepared.options.size);
    {
        const Stopwatch watch(timing_.images);
        prepared.scene = snapshot();
    }
    const Stopwatch watch(timing_.draw);
    prepared.resolved = easypbr::resolve(prepared.scene, settings_, prepared.options.size);
    const bool no_lens =
        settings_.depth_of_field.enabled && prepared.resolved.camera.projection == Projection::orthographic;
    if (no_lens && !warned_of_lens_)
        log_warning("depth_of_field.enabled: an orthographic camera has no lens, so nothing is blurred");
    warned_of_lens_ = no_lens;
    warn_of_surfels(prepared.scene);
    warn_of_shaders(prepared.scene);
    for (const render::CustomPass& custom : passes_)
        prepared.passes.emplace_back(custom.pass.get(), custom.pass->revision());
    return prepared;
}

void Session::warn_of_surfels(const SceneSnapshot& scene) {
    const auto lacks_normals = [&](const SceneSnapshot::Object& object) {
        const DrawStyle style = resolve_style(*object.mesh, settings_.style);
        return style.visible && style.mode == DrawMode::surfels && object.mesh->N.empty();
    };
    const auto found = std::find_if(scene.objects.begin(), scene.objects.end(), lacks_normals);
    const bool lacking = found != scene.objects.end();
    if (lacking && !warned_of_surfels_)
        log_warning(
            fmt::format("style.mode: '{}' has no normals to draw surfels from and is shown as points; "
                        "Mesh.estimate_surfels() and "
                        "'easypbr convert --to-surfels' make them",
                        found->name));
    warned_of_surfels_ = lacking;
}

TiledPicture Session::tiled(const Prepared& prepared) const {
    return {prepared.scene, prepared.resolved, prepared.options, settings_images_,
            tile_limits_.value_or(render::TileLimits::of(context_->info()))};
}

void Session::annotate(const Prepared& prepared) {
    annotation_ = annotation_of(prepared.scene, prepared.resolved.settings);
    annotation_settings_ = prepared.resolved.settings.annotation;
}

void Session::draw_frame(const PictureOptions& options) {
    begin_frame(options);
    const gl::ContextScope scope(*context_);
    const Stopwatch watch(timing_.draw);
    if (tiled_.empty()) renderer_->read_picture(1, 1);
}

void Session::begin_frame(const PictureOptions& options) {
    Prepared prepared = prepare(options);
    if (const auto begin = std::exchange(motion_begin_, std::nullopt))
        motion_ =
            std::make_shared<const Motion>(begin->first, begin->second.value_or(prepared.resolved.camera));
    if (settings_.motion_blur.enabled) prepared.options.motion = motion_;
    apply_lens(prepared);
    refined_.reset();
    render::Renderer& renderer = this->renderer();
    const gl::ContextScope scope(*context_);
    const Stopwatch watch(timing_.draw);
    tiled_ = {};
    if (const TiledPicture picture = tiled(prepared); picture.is_whole()) {
        renderer.draw(prepared.scene, prepared.resolved, prepared.options, settings_images_);
    } else {
        tiled_ = picture.draw(renderer);
    }
    annotate(prepared);
    motion_ = std::make_shared<const Motion>(prepared.scene, prepared.resolved.camera);
    latch_from(prepared);
}

bool Session::Refined::is_of(const Prepared& other, const render::SettingsImages& other_images) const {
    const render::DrawOptions &a = prepared.options, &b = other.options;
    const auto same_texture = [&](const NamedTexture& named) {
        return (images.textures.*named.texture).image == (other_images.textures.*named.texture).image;
    };
    return a.size == b.size && a.samples == b.samples && a.encoding == b.encoding && a.motion == b.motion &&
           images.background == other_images.background && prepared.passes == other.passes &&
           images.textures.shader == other_images.textures.shader &&
           images.shader_files == other_images.shader_files &&
           std::ranges::all_of(named_textures, same_texture) && same_scene(prepared.scene, other.scene) &&
           prepared.resolved.lights == other.resolved.lights &&
           same_settings(prepared.resolved.settings, other.resolved.settings);
}

Session::Refinement Session::refine(const PictureOptions& options, bool finish, const RefinedMotion& motion) {
    Prepared prepared = prepare(options);
    if (settings_.motion_blur.enabled) prepared.options.motion = motion;
    Refinement done;
    done.total = prepared.options.samples;
    done.began = !refined_ || !refined_->is_of(prepared, settings_images_);
    if (!done.began && refined_->frames == done.total) return done.frames = done.total, done;
    render::Renderer& renderer = this->renderer();
    const gl::ContextScope scope(*context_);
    const Stopwatch watch(timing_.draw);
    if (done.began) {
        refined_.reset();
        tiled_ = {};
        const Vec2i asked = prepared.options.size;
        apply_lens(prepared);
        renderer.begin(prepared.scene, prepared.resolved, prepared.options, settings_images_);
        annotate(prepared);
        latch_from(prepared);
        prepared.options.size = asked;  // What the next call compares with.
        refined_ = std::make_unique<Refined>(std::move(prepared), settings_images_);
    }
    done.drew = true;
    done.frames = refined_->frames = renderer.add_sample();
    if (finish || done.frames == done.total) renderer.finish();
    return done;
}

uint64_t Session::picture_version(std::optional<Vec2i> size) {
    Prepared prepared = prepare({size, 1, Encoding::srgb8});
    if (!versioned_ || !versioned_->is_of(prepared, settings_images_)) {
        versioned_ = std::make_unique<Refined>(std::move(prepared), settings_images_);
        ++version_;
    }
    return version_;
}

PickBuffer Session::pick_buffer(std::optional<Vec2i> size) {
    Prepared prepared = prepare({size, 1, Encoding::srgb8});
    const Camera camera = prepared.resolved.camera;
    // A complete picture stays what it is, and with it its lens; one that is being refined has to begin
    // again.
    if (refined_ && refined_->frames < refined_->prepared.options.samples) refined_.reset();
    const auto lens_before = lens_;
    const auto key_before = lens_key_;
    apply_lens(prepared);
    render::Renderer& renderer = this->renderer();
    const gl::ContextScope scope(*context_);
    renderer.draw_surfaces(prepared.scene, prepared.resolved, prepared.options.size, settings_images_);
    latch_from(prepared);
    PickBuffer surfaces(renderer.read_surfaces(), camera, lens_);
    lens_ = lens_before;
    lens_key_ = key_before;
    return surfaces;
}

ViewPoint Session::view_point(std::optional<Vec2i> size) {
    const ResolvedSettings resolved = resolve(size);
    return {resolved.camera, *resolved.settings.camera.target};
}

void Session::set_view_point(const ViewPoint& view) {
    CameraSettings& to = settings_.camera;
    const Auto<double> near = to.near;
    set_camera(view.camera);
    to.near = near;
    to.position.latch(view.camera.position());
    to.target.latch(view.target);
    const double nearest = near_part * view.distance();
    if (to.near.value() && !to.near.is_pinned()) to.near.latch(std::min(*to.near.value(), nearest));
}

gl::Context& Session::context() {
    renderer();
    return *context_;
}

std::vector<std::pair<std::string, double>> Session::measure_passes(const PictureOptions& options) {
    renderer().measure_passes(true);
    draw_frame(options);
    renderer().measure_passes(false);
    return renderer().pass_times();
}

std::map<std::string, Image> Session::render_layers(const std::vector<std::string>& names,
                                                    std::optional<Vec2i> size) {
    std::vector<render::Layer> layers;
    for (const std::string& name : names) layers.push_back(render::layer_named(name));
    Prepared prepared = prepare({size, 1, Encoding::scene_linear});
    prepared.options.layers = true;
    prepared.options.ids = std::ranges::any_of(layers, [](render::Layer layer) {
        return layer == render::Layer::object_id || layer == render::Layer::element_id;
    });
    apply_lens(prepared);
    render::Renderer& renderer = this->renderer();
    const gl::ContextScope scope(*context_);
    refined_.reset();
    std::vector<Image> drawn;
    if (const TiledPicture picture = tiled(prepared); picture.is_whole()) {
        renderer.draw(prepared.scene, prepared.resolved, prepared.options, settings_images_);
        for (const render::Layer layer : layers) drawn.push_back(renderer.read_layer(layer));
    } else {
        drawn = picture.draw_layers(renderer, layers);
    }
    latch_from(prepared);
    std::map<std::string, Image> images;
    for (size_t i = 0; i < names.size(); ++i) images[names[i]] = pick_nearest(drawn[i], *lens_);
    return images;
}

void Session::apply_lens(Prepared& prepared) {
    const Camera& camera = prepared.resolved.camera;
    std::vector<double> key = {double(prepared.options.size.x()), double(prepared.options.size.y())};
    if (camera.is_warped()) {
        const Intrinsics& k = *camera.intrinsics;
        key.insert(key.end(), {k.fx, k.fy, k.cx, k.cy, double(k.width), double(k.height), k.skew});
        if (camera.distortion) {
            key.push_back(double(camera.distortion->model));
            key.insert(key.end(), camera.distortion->k.begin(), camera.distortion->k.end());
        }
    }
    if (key != lens_key_) {
        lens_ = std::make_shared<const LensMap>(lens_map(camera, prepared.options.size));
        lens_key_ = key;
    }
    if (!camera.is_warped()) return;
    prepared.options.size = lens_->drawn_size;
    prepared.resolved.camera.distortion.reset();
    prepared.resolved.camera.intrinsics = lens_->drawn.intrinsics;
}

void Session::draw_centres(const PictureOptions& options, bool picture, const Moment* moment) {
    Prepared prepared = prepare(options);
    prepared.options.surfaces = true;
    if (moment) prepared.resolved.camera = moment->camera;
    apply_lens(prepared);
    render::Renderer& renderer = this->renderer();
    const gl::ContextScope scope(*context_);
    const Stopwatch watch(timing_.draw);
    refined_.reset();
    tiled_ = {};
    if (picture && !moment)
        renderer.draw(prepared.scene, prepared.resolved, prepared.options, settings_images_);
    else
        renderer.draw_surfaces(moment ? moment->scene : prepared.scene, prepared.resolved,
                               prepared.options.size, settings_images_);
    annotate(prepared);
    if (!moment) latch_from(prepared);
}

render::SurfaceFrame Session::draw_surfaces(const PictureOptions& options, bool picture,
                                            const Moment* moment) {
    draw_centres(options, picture, moment);
    const gl::ContextScope scope(*context_);
    return renderer_->read_surfaces();
}

Image Session::drawn_layer(render::Layer layer) {
    const gl::ContextScope scope(*context_);
    return renderer_->read_layer(layer);
}

std::vector<uint8_t> Session::coverage(const render::PixelRect& area,
                                       const std::function<bool(size_t, int)>& wanted) {
    const gl::ContextScope scope(*context_);
    return renderer_->coverage(area, wanted);
}

Moment Session::moment(std::optional<Vec2i> size) {
    Moment moment{snapshot(), {}};
    moment.camera = easypbr::resolve(moment.scene, settings_, size_or(size)).camera;
    return moment;
}

double Session::focus_at(int x, int y, std::optional<Vec2i> size) {
    const Vec2i pixels = size_or(size);
    if (x < 0 || y < 0 || x >= pixels.x() || y >= pixels.y())
        throw ArgumentError(fmt::format("focus: expected a pixel of the picture of {}x{}, got ({}, {})",
                                        pixels.x(), pixels.y(), x, y));
    const double depth = render_layers({"depth"}, pixels).at("depth").at<float>(x, y)[0];
    if (!(depth > 0))
        throw ArgumentError(fmt::format("focus: pixel ({}, {}) shows nothing to focus on", x, y));
    settings_.depth_of_field.focus_distance = depth;
    return depth;
}

void Session::replace_settings(const Settings& settings) {
    settings_ = settings;
    environment_hash_.reset();
}

void Session::latch_from(const Prepared& prepared) {
    if (prepared.scene.objects.empty()) return;
    latch(settings_, prepared.resolved.settings);
    for (const auto& [name, radius] : prepared.resolved.light_radii) scene_.latch_light_radius(name, radius);
}

void Session::load_environment(const std::filesystem::path& path) {
    environment_ = Environment(path);
    environment_file_ = settings_.environment.file = path.string();
}

std::vector<std::string> Session::object_names() const {
    std::vector<std::string> names;
    for (const auto& object : scene_.snapshot().objects) names.push_back(object.name);
    return names;
}

void Session::set_camera(const Camera& camera) {
    CameraSettings& to = settings_.camera;
    // A pose replaces both; what they were still says how far away the target is.
    for (Auto<Vec3d>* replaced : {&to.position, &to.target}) {
        const std::optional<Vec3d> known = replaced->value();
        *replaced = automatic;
        if (known) replaced->latch(*known);
    }
    const Mat4d T = camera.T_world_cam.matrix();
    to.pose.clear();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) to.pose.push_back(T(row, column));
    // Where the near plane may lie depends on the pose: a path may lead nearer than the first picture was.
    to.near.release();
    to.projection = camera.projection;
    to.fov_y_deg = float(camera.fov_y_deg);
    to.ortho_height = camera.ortho_height;
    to.intrinsics.clear();
    if (camera.intrinsics) {
        const Intrinsics& k = *camera.intrinsics;
        to.intrinsics = {k.fx, k.fy, k.cx, k.cy, double(k.width), double(k.height)};
        if (k.skew != 0) to.intrinsics.push_back(k.skew);
    }
    to.distortion.clear();
    if (camera.distortion) {
        to.distortion_model = camera.distortion->model;
        to.distortion = camera.distortion->coefficients();
    }
}

}  // namespace easypbr::app
