#include "easypbr/app/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/app/annotation.h"
#include "easypbr/app/prepared.h"
#include "easypbr/core/error.h"
#include "easypbr/core/stopwatch.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {

void check_picture_size(Vec2i size) {
    if (size.x() < 1 || size.y() < 1 || size.x() > max_image_side || size.y() > max_image_side)
        throw ArgumentError(fmt::format("picture size {}x{}: width and height must be 1 to {}", size.x(),
                                        size.y(), max_image_side));
    if (int64_t(size.x()) * size.y() > max_picture_pixels)
        throw ArgumentError(
            fmt::format("picture size {}x{}: expected {} pixels at most, such as 32768x32768 or 65536x16384",
                        size.x(), size.y(), max_picture_pixels));
}

void check_focus(Vec2i pixel, Vec2i size) {
    if (pixel.minCoeff() < 0 || pixel.x() >= size.x() || pixel.y() >= size.y())
        throw ArgumentError(fmt::format("focus: expected a pixel of the picture of {}x{}, got ({}, {})",
                                        size.x(), size.y(), pixel.x(), pixel.y()));
}

struct Session::Refined {
    Prepared prepared;
    Drawn frames_drawn;  ///< of all frames, when they are finished
    Drawn drawn;         ///< finished last
    int frames = 0;
    bool is_complete = false;  ///< maybe with fewer frames than asked for
    uint64_t device = 0;       ///< KeptDevice::number()
    uint64_t sum = 0;          ///< Device::sum

    /// Nothing else was drawn that it is lost by.
    bool is_there(const KeptDevice& now) const {
        if (device != now.number()) return false;
        return is_complete ? drawn.picture_ == now->picture : sum == now->sum;
    }
};

Session::Session(const Scene& scene) : scene_(scene), settings_(std::make_unique<Settings>()) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

Session Session::beside() const {
    Session other(scene_);
    *other.settings_ = *settings_;
    other.files_ = files_;
    other.environment_hash_ = environment_hash_;
    other.latched_content_ = latched_content_;
    other.passes_ = passes_;
    other.tile_limits_ = tile_limits_;
    other.device_ = device_;
    return other;
}

const gl::ContextInfo& Session::context_info() {
    return device_.info();
}

gl::Context& Session::context() {
    device_.replace_lost();
    renderer();
    return *device_->context;
}

render::Renderer& Session::renderer() {
    if (!device_->renderer) {
        const Stopwatch watch(timing_.context);
        context_info();
        const gl::ContextScope scope(*device_->context);
        device_->renderer = std::make_unique<render::Renderer>();
        device_->renderer->set_passes(passes_);
    }
    return *device_->renderer;
}

SceneSnapshot Session::snapshot() {
    files_.load(*settings_);
    SceneSnapshot scene = scene_.snapshot();
    files_.load_shaders(*settings_, scene);
    if (!files_.environment().empty()) scene.environment = files_.environment();
    const std::string hash = scene.environment.empty() ? "" : scene.environment.hash();
    if (environment_hash_ && hash != *environment_hash_) {
        // Which lights are on and how the picture is exposed follows from the environment: they are inferred
        // anew.
        for (StudioLight* light : {&settings_->lights.key, &settings_->lights.fill, &settings_->lights.rim})
            light->enabled.release();
        settings_->environment.sun.release();
        settings_->tonemap.exposure.release();
    }
    environment_hash_ = hash;
    latched_content_.release_camera(*settings_);
    if (latched_content_.release_outgrown(scene, *settings_)) {
        scene_.release_light_radii();
        for (auto& [name, light] : scene.lights) light.radius.release();
    }
    return scene;
}

Prepared Session::prepare(const PictureOptions& options) {
    Prepared prepared = gather(options);
    infer(prepared);
    return prepared;
}

Prepared Session::gather(const PictureOptions& options) {
    timing_ = {};
    Prepared prepared;
    prepared.options.size = size_or(options.size);
    prepared.options.samples = options.samples.value_or(settings_->image.samples);
    prepared.options.encoding = options.encoding;
    check_picture_size(prepared.options.size);
    for (const render::CustomPass& custom : passes_)
        prepared.passes.emplace_back(custom.pass.get(), custom.pass->revision());
    const Stopwatch watch(timing_.images);
    prepared.scene = snapshot();
    prepared.images = files_.images();
    return prepared;
}

void Session::infer(Prepared& prepared) {
    const Stopwatch watch(timing_.draw);
    prepared.resolved = resolve_framed(prepared.scene, prepared.options.size, prepared.options.samples);
    latched_content_.follow(prepared.scene, *settings_, prepared.resolved);
    warnings_.check(prepared.scene, *settings_, prepared.resolved);
}

TiledPicture Session::tiled(const Prepared& prepared) const {
    return {prepared.scene, prepared.resolved, prepared.options, prepared.images,
            tile_limits_.value_or(render::TileLimits::of(device_->context->info()))};
}

Drawn Session::begin(Prepared& prepared, bool picture, bool surfaces) {
    Drawn drawn;
    drawn.camera_ = prepared.resolved.camera;
    apply_lens(drawn, prepared, picture);
    renderer();
    drawn.device_ = device_.shared();
    // Numbers are taken before anything is drawn: a drawing that fails outdates what was there as well.
    ++device_->surfaces;
    ++device_->sum;
    if (picture) drawn.picture_ = ++device_->picture;
    if (surfaces) drawn.surfaces_ = device_->surfaces;
    return drawn;
}

void Session::annotate(Drawn& drawn, const Prepared& prepared) {
    Annotation annotation = annotation_of(prepared.scene, prepared.resolved.settings);
    warnings_.check(annotation, prepared.resolved.settings.annotation, drawn.lens().size);
    if (annotation.empty()) return;
    drawn.finish_.annotate = [annotation = std::move(annotation),
                              settings = prepared.resolved.settings.annotation](Image& picture) {
        draw_annotation(annotation, settings, picture);
    };
}

Drawn Session::draw(const PictureOptions& options) {
    return device_.keep([&] { return draw_once(options); });
}

Drawn Session::draw_once(const PictureOptions& options) {
    Prepared prepared = prepare(options);
    const std::shared_ptr<const Motion> before = motion_.before(prepared.scene, prepared.resolved.camera);
    if (settings_->motion_blur.enabled) prepared.options.motion = before;
    refined_.reset();
    warnings_.check_light(prepared.scene, *settings_, prepared.resolved);
    Drawn drawn = begin(prepared, true, false);
    const gl::ContextScope scope(*device_->context);
    const Stopwatch watch(timing_.draw);
    if (const TiledPicture picture = tiled(prepared); picture.is_whole()) {
        device_->renderer->draw(prepared.scene, prepared.resolved, prepared.options, prepared.images);
        keep_exact(drawn, device_->renderer->exact_pixels());
    } else {
        Image exact;
        drawn.tiled_ = std::make_shared<const Image>(picture.draw(*device_->renderer, exact));
        keep_exact(drawn, exact);
    }
    gl::Context::check();
    annotate(drawn, prepared);
    motion_.keep(prepared.scene, drawn.camera());
    latch_from(prepared);
    return drawn;
}

Drawn Session::draw_frame(const PictureOptions& options) {
    Drawn drawn = draw(options);
    wait_for(drawn);
    return drawn;
}

void Session::wait_for(const Drawn& drawn) {
    const Stopwatch watch(timing_.draw);
    drawn.wait();
}

Image Session::render(const PictureOptions& options) {
    return device_.keep([&] {
        const Drawn drawn = draw_once(options);
        wait_for(drawn);
        const Stopwatch watch(timing_.read);
        return drawn.picture();
    });
}

Session::Refinement Session::refine(const PictureOptions& options, bool finish, const RefinedMotion& motion) {
    return device_.keep([&] { return refine_once(options, finish, motion); });
}

Session::Refinement Session::refine_once(const PictureOptions& options, bool finish,
                                         const RefinedMotion& motion) {
    Prepared prepared = prepare(options);
    if (settings_->motion_blur.enabled) prepared.options.motion = motion;
    Refinement done;
    done.total = prepared.options.samples;
    done.began = !refined_ || !refined_->is_there(device_) || !same_picture(refined_->prepared, prepared);
    if (!done.began && refined_->is_complete) {
        done.frames = done.total = refined_->frames;
        done.drawn = refined_->drawn;
        return done;
    }
    render::Renderer& renderer = this->renderer();
    const gl::ContextScope scope(*device_->context);
    const Stopwatch watch(timing_.draw);
    if (done.began) {
        refined_.reset();
        warnings_.check_light(prepared.scene, *settings_, prepared.resolved);
        const render::DrawOptions asked = prepared.options;
        Drawn drawn = begin(prepared, true, false);
        renderer.begin(prepared.scene, prepared.resolved, prepared.options, prepared.images);
        annotate(drawn, prepared);
        latch_from(prepared);
        prepared.options = asked;  // What the next call compares with.
        refined_ = std::make_unique<Refined>(
            Refined{std::move(prepared), std::move(drawn), {}, 0, false, device_.number(), device_->sum});
    }
    done.drew = true;
    try {
        done.frames = refined_->frames = renderer.add_sample();
    } catch (...) {
        refined_.reset();  // Half a sample may be in its sum.
        throw;
    }
    refined_->is_complete = renderer.is_complete();
    if (refined_->is_complete) done.total = done.frames;
    if (finish || refined_->is_complete) {
        renderer.finish();
        refined_->drawn = refined_->frames_drawn;
        keep_exact(refined_->drawn, renderer.exact_pixels());
        refined_->drawn.picture_ = ++device_->picture;
    }
    gl::Context::check();
    done.drawn = refined_->drawn;
    return done;
}

uint64_t Session::picture_version(std::optional<Vec2i> size) {
    Prepared prepared = gather({size, 1, Encoding::srgb8});
    // A view at rest asks several times a second: to infer the same again takes most of the time.
    const bool is_known = version_.of && version_.insets == insets_ && same_content(*version_.of, prepared) &&
                          are_equal(*version_.settings, *settings_);
    if (is_known) return version_.number;
    infer(prepared);
    if (!version_.of || !same_picture(*version_.of, prepared)) ++version_.number;
    version_.of = std::make_unique<Prepared>(std::move(prepared));
    version_.settings = std::make_unique<Settings>(*settings_);
    version_.insets = insets_;
    return version_.number;
}

PickBuffer Session::pick_buffer(std::optional<Vec2i> size) {
    return device_.keep([&] { return pick_once(size); });
}

PickBuffer Session::pick_once(std::optional<Vec2i> size) {
    Prepared prepared = prepare({size, 1, Encoding::srgb8});
    const Drawn drawn = begin(prepared, false, true);
    {
        const gl::ContextScope scope(*device_->context);
        device_->renderer->draw_surfaces(prepared.scene, prepared.resolved, prepared.options.size,
                                         prepared.images);
        gl::Context::check();
    }
    latch_from(prepared);
    return {drawn.surfaces(), drawn.camera(), drawn.shared_lens()};
}

std::map<std::string, Image> Session::render_layers(const std::vector<std::string>& names,
                                                    std::optional<Vec2i> size) {
    std::vector<render::Layer> layers;
    for (const std::string& name : names) layers.push_back(render::layer_named(name));
    return device_.keep([&] { return render_layers_once(names, layers, size); });
}

std::map<std::string, Image> Session::render_layers_once(const std::vector<std::string>& names,
                                                         const std::vector<render::Layer>& layers,
                                                         std::optional<Vec2i> size) {
    Prepared prepared = prepare({size, 1, Encoding::scene_linear});
    prepared.options.layers = true;
    prepared.options.occlusion = std::ranges::find(layers, render::Layer::ambient_occlusion) != layers.end();
    prepared.options.ids = std::ranges::any_of(layers, [](render::Layer layer) {
        return layer == render::Layer::object_id || layer == render::Layer::element_id;
    });
    const bool has_depth = std::ranges::find(layers, render::Layer::depth) != layers.end();
    prepared.options.surfaces = has_depth && prepared.resolved.camera.is_warped();
    refined_.reset();
    const Drawn begun = begin(prepared, true, false);
    render::Renderer& renderer = *device_->renderer;
    const gl::ContextScope scope(*device_->context);
    std::vector<Image> drawn;
    render::SurfaceFrame surfaces;
    if (const TiledPicture picture = tiled(prepared); picture.is_whole()) {
        renderer.draw(prepared.scene, prepared.resolved, prepared.options, prepared.images);
        for (const render::Layer layer : layers) drawn.push_back(renderer.read_layer(layer));
        if (prepared.options.surfaces) surfaces = renderer.read_surfaces();
    } else {
        drawn = picture.draw_layers(renderer, layers, surfaces);
    }
    gl::Context::check();
    latch_from(prepared);
    std::map<std::string, Image> images;
    for (size_t i = 0; i < names.size(); ++i) images[names[i]] = pick_nearest(drawn[i], begun.lens());
    // The nearest drawn pixel has another ray: on a slanted face it is at another depth.
    if (prepared.options.surfaces)
        images["depth"] = PickBuffer(std::move(surfaces), begun.camera(), begun.shared_lens()).depths();
    return images;
}

Drawn Session::draw_surfaces(const PictureOptions& options, bool picture, const Moment* moment) {
    return device_.keep([&] { return draw_surfaces_once(options, picture, moment); });
}

Drawn Session::draw_surfaces_once(const PictureOptions& options, bool picture, const Moment* moment) {
    Prepared prepared = prepare(options);
    prepared.options.surfaces = true;
    if (moment) prepared.resolved.camera = moment->camera;
    refined_.reset();
    const bool with_picture = picture && !moment;
    Drawn drawn = begin(prepared, with_picture, true);
    const gl::ContextScope scope(*device_->context);
    const Stopwatch watch(timing_.draw);
    if (with_picture) {
        device_->renderer->draw(prepared.scene, prepared.resolved, prepared.options, prepared.images);
        keep_exact(drawn, device_->renderer->exact_pixels());
    } else {
        device_->renderer->draw_surfaces(moment ? moment->scene : prepared.scene, prepared.resolved,
                                         prepared.options.size, prepared.images);
    }
    gl::Context::check();
    annotate(drawn, prepared);
    if (!moment) latch_from(prepared);
    return drawn;
}

Moment Session::moment(std::optional<Vec2i> size) {
    Moment moment{snapshot(), {}};
    moment.camera = resolve_framed(moment.scene, size_or(size)).camera;
    return moment;
}

double Session::focus_at(int x, int y, std::optional<Vec2i> size) {
    const Vec2i pixels = size_or(size);
    check_focus({x, y}, pixels);
    const double depth = render_layers({"depth"}, pixels).at("depth").at<float>(x, y)[0];
    if (!(depth > 0))
        throw ArgumentError(fmt::format("focus: pixel ({}, {}) shows nothing to focus on", x, y));
    settings_->depth_of_field.focus_distance = depth;
    return depth;
}

void Session::refit() {
    release(*settings_);
    scene_.release_light_radii();
}

Vec2i Session::size_or(std::optional<Vec2i> size) const {
    return size.value_or(settings_->image.size);
}

void Session::replace_settings(const Settings& settings) {
    *settings_ = settings;
    environment_hash_.reset();
    latched_content_ = {};
}

void Session::latch_from(const Prepared& prepared) {
    if (prepared.scene.objects.empty()) return;
    latch(*settings_, prepared.resolved.settings);
    latched_content_.keep(prepared.scene, prepared.resolved.settings.annotation);
    for (const auto& [name, radius] : prepared.resolved.light_radii) scene_.latch_light_radius(name, radius);
}

void Session::load_environment(const std::filesystem::path& path) {
    files_.load_environment(path);
    settings_->environment.file = path.string();
}

void Session::load_background(const std::filesystem::path& path) {
    files_.load_background(path);
    settings_->background.image = path.string();
    settings_->background.mode = BackgroundMode::image;
}

void Session::set_background(Image image) {
    files_.set_background(std::move(image));
    settings_->background.image.clear();
    settings_->background.mode = BackgroundMode::image;
}

std::vector<std::string> Session::object_names() const {
    std::vector<std::string> names;
    for (const auto& object : scene_.snapshot().objects) names.push_back(object.name);
    return names;
}

}  // namespace easypbr::app
