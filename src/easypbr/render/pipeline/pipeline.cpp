#include "easypbr/render/pipeline/pipeline.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "easypbr/core/color.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

bool is_layered(const DrawItem& item) {
    return item.layered;
}

/// The ground, and what is drawn larger than it is, reach beyond the bounds of what casts.
ShadowMaps::Receivers receivers_of(const DrawList& list, const FrameContents& contents) {
    if (!contents.ground && !list.has(&DrawItem::receives_shadows)) return ShadowMaps::Receivers::none;
    if (contents.ground) return ShadowMaps::Receivers::on_ground;
    return list.has(&DrawItem::reaches_beyond) ? ShadowMaps::Receivers::around
                                               : ShadowMaps::Receivers::within;
}

/// What a frame of native surfaces needs the driver for where it is not lit natively.
std::string lit_by_driver(bool native_shading) {
    return native_shading ? "shadows" : "lighting";
}

RayGround ray_ground(const ResolvedSettings& resolved) {
    const auto& ground = resolved.settings.ground;
    const bool catches = GroundPass::is_shadow_catcher(resolved);
    return {.up = parse_up(resolved.settings.camera.up),
            .height = ground.height,
            .radius = catches ? std::numeric_limits<double>::infinity() : double(ground.radius),
            .color = linear_from_srgb(ground.plane_color),
            .roughness = ground.plane_roughness,
            .shadow_catcher = catches};
}

}  // namespace

void Pipeline::begin(Vec2i size) {
    gl::reset_state();
    if (targets_.size() != size) targets_ = GBuffer(size);
    timer_.reset();
    transfers_ = {};
}

void Pipeline::prepare_environment(const ResolvedSettings& resolved) {
    if (resolved.environment.empty()) return;
    timer_.run("environment", [&] {
        const bool seen = resolved.settings.background.shows_environment();
        environment_.prepare(resolved.environment, seen ? resolved.seen_environment : Environment());
    });
}

LitPicture Pipeline::draw(const Frame& frame, const DrawList& list, const DrawList& casters,
                          const FrameContents& contents) {
    const ResolvedSettings& resolved = *frame.resolved;
    const Box3d& bounds = bounds_of(*frame.scene);
    const bool has_layers = list.has(is_layered);
    const DrawList solid = has_layers ? list.without_layers() : DrawList();
    const DrawList& opaque = has_layers ? solid : list;
    const bool with_overlay = list.needs_overlay() || draws_overlay(frame, contents);
    const SurfaceOutputs outputs{.ids = contents.ids,
                                 .extensions = contents.ids || contents.paths ? 0 : opaque.extensions(),
                                 .whole = (contents.ground || has_layers) && native_shading_};
    add_targets(with_overlay, outputs.extensions != 0);

    const PixelRect drawn =
        timer_.run("geometry", [&] { return surfaces_.draw(frame, opaque, targets_, outputs); });
    if (contents.paths) surfaces_.release();  // paths take longer than clearing new memory
    const Frame seen = frame.covering(contents.ground ? frame.covered : drawn);
    shadow_maps_.begin(seen, casters, receivers_of(list, contents));
    const bool native = is_lit_natively(list, contents);
    shadow_maps_.keep_in_host_memory(native);
    find_place_light(frame, list, casters, contents);
    const std::string pass = native ? first_by_driver(list, contents) : lit_by_driver(native_shading_);
    if (!native && targets_.depth.is_ahead()) timer_.run(pass, [&] { targets_.upload(transfers_); });
    if (contents.ground)
        timer_.run("ground", [&] { native ? ground_.shade(seen, targets_) : ground_.draw(seen, targets_); });
    // Where nothing is lit rays need no tree of what casts.
    const DrawList& met = list.empty() && !contents.ground ? list : casters;
    light_surfaces(seen, met, contents, {.native = native, .extensions = outputs.extensions},
                   surfaces_in(frame, opaque, contents));
    const bool shows_environment =
        !resolved.environment.empty() && resolved.settings.background.shows_environment();
    if (native) shade_surroundings(seen, contents, shows_environment);
    if (native && !pass.empty()) timer_.run(pass, [&] { targets_.upload(transfers_); });
    if (!native && contents.ground) timer_.run("ground", [&] { ground_.finish(seen, targets_, bounds); });
    if (with_overlay) timer_.run("display", [&] { begin_overlay(seen, list, contents, pass.empty()); });
    if (!has_layers) timer_.run("overlays", [&] { draw_overlay_items(seen, list, pass.empty()); });
    if (!native && shows_environment)
        timer_.run("background", [&] { background_.draw(seen, targets_, environment_, contents.ground); });

    LitPicture lit{.radiance = &targets_.radiance,
                   .overlay = with_overlay ? &targets_.overlay : nullptr,
                   .caught = contents.ground ? ground_.caught(resolved) : nullptr,
                   .covered = has_layers ? frame.covered : seen.covered,
                   .partly_covered = contents.ground && !frame.averages_radiance};
    if (has_layers) draw_transparent(frame, list, contents, {pass.empty(), with_overlay}, lit);
    lit.lines = overlays_.nearest_lines(list.overlays);
    if (contents.custom) contents.custom->draw_in_frame(frame, targets_, timer_, lit);
    draw_effects(frame, opaque, {.native = pass.empty(), .overlay_only = contents.only_layers}, lit);
    return lit;
}

void Pipeline::add_targets(bool overlay, bool extensions) {
    if (overlay) targets_.add_overlay();
    if (extensions) targets_.add_extensions();
}

void Pipeline::light_surfaces(const Frame& frame, const DrawList& casters, const FrameContents& contents,
                              const LightInputs& inputs, const AmbientOcclusionPass::Surfaces& surfaces) {
    const ResolvedSettings& resolved = *frame.resolved;
    const bool caught = contents.ground && GroundPass::is_shadow_catcher(resolved);
    if (contents.traced || contents.paths)
        timer_.run("rays", [&] {
            update_ray_scene(frame, casters, contents.ground);
            if (!contents.paths && !casters.of(DrawMode::splats).empty()) ray_scene_.make_surfaces(resolved);
        });
    // The target's being there says that it holds this frame's.
    const bool occludes = resolved.settings.ssao.enabled && !contents.traced && !contents.paths;
    if (!occludes) targets_.remove_ambient_occlusion();
    if (contents.paths) return trace_paths(frame, contents, inputs.native, caught);
    if (occludes) occlude(frame, inputs.native, surfaces);
    light(frame, targets_, contents, inputs, caught);
}

void Pipeline::trace_paths(const Frame& frame, const FrameContents& contents, bool native, bool caught) {
    timer_.run("paths", [&] {
        const bool first = frame.sample_index == 0 && !contents.only_layers;
        if (first || frame.motion) ray_scene_.make_surfaces(*frame.resolved);
        const Target* part = caught ? &ground_.caught_part(frame) : nullptr;
        if (contents.only_layers)
            paths_.begin_layers(frame, targets_, ray_scene_, part);
        else
            paths_.draw(frame, targets_, ray_scene_, part, contents.tiles, transfers_);
        if (native) return;
        targets_.radiance.upload(transfers_);
        if (caught) ground_.caught_part(frame).upload(transfers_);
    });
}

void Pipeline::begin_overlay(const Frame& frame, const DrawList& list, const FrameContents& contents,
                             bool native) {
    const bool whole = list.has(is_layered) || draws_overlay(frame, contents);
    const PixelRect area = whole ? frame.whole() : frame.covered;
    if (native)
        display_.shade_overlay(frame, targets_, area, transfers_);
    else
        display_.draw(frame, targets_);
}

void Pipeline::shade_surroundings(const Frame& frame, const FrameContents& contents, bool environment) {
    const bool ground = contents.ground;
    if (ground)
        timer_.run("ground",
                   [&] { ground_.shade_finish(frame, targets_, bounds_of(*frame.scene), transfers_); });
    if (environment)
        timer_.run("background",
                   [&] { background_.shade(frame, targets_, environment_, ground, transfers_); });
}

AmbientOcclusionPass::Surfaces Pipeline::surfaces_in(const Frame& frame, const DrawList& opaque,
                                                     const FrameContents& contents) {
    AmbientOcclusionPass::Surfaces surfaces{
        .points = opaque.needs_overlay() || draws_overlay(frame, contents),
        .mapped_normals = opaque.has(&DrawItem::has_mapped_normals)};
    if (contents.ground && !opaque.reaches_beyond_vertices()) surfaces.occluders = bounds_of(*frame.scene);
    return surfaces;
}

void Pipeline::occlude(const Frame& frame, bool native, const AmbientOcclusionPass::Surfaces& surfaces) {
    timer_.run("ambient occlusion", [&] {
        if (native)
            ambient_occlusion_.shade(frame, targets_, surfaces, transfers_);
        else
            ambient_occlusion_.draw(frame, targets_, surfaces);
    });
}

bool Pipeline::is_lit_natively(const DrawList& list, const FrameContents& contents) const {
    if (!native_shading_ || !targets_.depth.is_ahead()) return false;
    if (contents.paths || !shadow_maps_.has_shadows()) return true;
    if (shadow_maps_.has_tints() && !shadow_maps_.has_native_tints()) return false;
    // Layers by the driver need the maps where it can read them.
    return !list.has(is_layered) || first_by_driver(list, contents).empty();
}

std::string Pipeline::first_by_driver(const DrawList& list, const FrameContents& contents) const {
    if (list.has(is_layered) && !has_native_layers(list)) return "transparency";
    if (contents.custom && !contents.custom->empty()) return "custom passes";
    return contents.in_host_memory ? "" : "output";
}

void Pipeline::light(const Frame& frame, const GBuffer& targets, const FrameContents& contents,
                     LightInputs inputs, bool caught) {
    shadow_maps_.rewind();
    if (contents.traced) {
        timer_.run("rays", [&] { rays_.draw(frame, targets, ray_scene_, transfers_); });
        if (!inputs.native) rays_.light().upload(transfers_);
        inputs.traced = &rays_.light();
    }
    if (caught && !inputs.native) ground_.begin_light(frame, targets);
    if (!frame.resolved->environment.empty()) inputs.environment = &environment_;
    if (contents.ground && !contents.traced)
        inputs.ground = GroundPass::mirrored(frame, bounds_of(*frame.scene));
    if (inputs.native) {
        const bool whole = &targets == &targets_ && inputs.environment &&
                           frame.resolved->settings.background.shows_environment();
        targets.radiance.write(whole ? frame.whole() : targets.depth.area());
    }
    bool first = true;
    do {
        timer_.run("shadows", [&] { inputs.block = shadow_maps_.next_block(); });
        inputs.block.first = first;
        timer_.run("lighting", [&] {
            if (inputs.native)
                lighting_.shade(frame, targets, inputs, transfers_);
            else
                lighting_.draw(frame, targets, inputs);
        });
        if (caught)
            timer_.run("ground", [&] {
                if (inputs.native)
                    lighting_.shade_caught(frame, targets, inputs, ground_.caught_light(frame), transfers_);
                else
                    lighting_.draw_caught(frame, targets, inputs, ground_.light());
            });
        inputs.environment = nullptr;
        inputs.ground.reset();
        first = false;
    } while (shadow_maps_.has_more());
}

void Pipeline::update_ray_scene(const Frame& frame, const DrawList& casters, bool ground) {
    std::optional<RayGround> plane;
    if (ground && GroundPass::is_seen(frame)) plane = ray_ground(*frame.resolved);
    ray_scene_.update(casters, shadow_maps_.caster_bounds(), shadow_maps_.casters_generation(), primitives_,
                      plane);
}

void Pipeline::find_place_light(const Frame& frame, const DrawList& list, const DrawList& casters,
                                const FrameContents& contents) {
    const ResolvedSettings& resolved = *frame.resolved;
    const SplatSettings& splats = resolved.settings.splats;
    const bool is_lit = !resolved.lights.empty() || !resolved.environment.empty(),
               has_splats = list.overlays.contains(DrawMode::splats);
    const bool relights = has_splats && splats.relight;
    bool receives = has_splats && splats.receive && is_lit;
    darkening_ = {};
    if (receives) {
        darkening_ = casters;
        darkening_.items.erase(DrawMode::splats);
        receives = !darkening_.empty();
    }
    if (receives || relights)
        timer_.run("rays", [&] {
            const bool occludes = resolved.settings.ssao.enabled || contents.traced || contents.paths;
            received_light_.update(frame,
                                   {darkening_, shadow_maps_.casters_generation(), primitives_, occludes});
        });
    for (const auto& kind : primitives_)
        kind->set_place_light(receives || relights ? &received_light_ : nullptr);
}

bool Pipeline::draws_overlay(const Shot& shot, const FrameContents& contents) const {
    if (has_custom(contents.custom, Stage::overlay)) return true;
    return std::ranges::any_of(
        effects_, [&](const auto& effect) { return effect->draws_overlay() && effect->is_on(shot); });
}

bool Pipeline::spreads_light(const Shot& shot) const {
    return shot.through_lens || shot.motion || std::ranges::any_of(effects_, [&](const auto& effect) {
               return !effect->draws_overlay() && effect->is_on(shot);
           });
}

void Pipeline::draw_effects(const Frame& frame, const DrawList& opaque, EffectKinds kinds, LitPicture& lit) {
    bool has_ids = false;
    const auto with_ids = [&]() -> const GBuffer& {
        if (std::exchange(has_ids, true)) return with_ids_;
        if (with_ids_.size() != frame.size) with_ids_ = GBuffer(frame.size);
        with_ids_.add_ids();
        surfaces_.draw(frame, opaque, with_ids_, {.ids = true});
        if (!kinds.native) with_ids_.upload(transfers_);
        return with_ids_;
    };
    // The frames of an accumulated picture look through different places of the lens.
    lit.spreads |= frame.through_lens;
    for (const auto& effect : effects_) {
        if (!effect->is_on(frame) || (kinds.overlay_only && !effect->draws_overlay())) continue;
        const Frame seen = frame.covering(lit.covered);
        const EffectInputs inputs{seen, targets_, bounds_of(*frame.scene), with_ids};
        timer_.run(effect->name(), [&] {
            kinds.native ? effect->shade(inputs, lit, transfers_) : effect->draw(inputs, lit);
        });
    }
}

void Pipeline::draw_surfaces(const Frame& frame, const DrawList& list, const SurfaceOutputs& outputs) {
    if (outputs.ids) targets_.add_ids();
    surfaces_.draw(frame, list, targets_, outputs);
}

void Pipeline::occlude_surfaces(const Frame& frame, const DrawList& list) {
    if (!frame.resolved->settings.ssao.enabled) return;
    const bool native = native_shading_ && targets_.depth.is_ahead();
    if (!native && targets_.depth.is_ahead()) targets_.upload(transfers_);
    occlude(frame, native, surfaces_in(frame, list, {}));
}

const Target* Pipeline::draw_overlay(const Frame& frame, const DrawList& list, const FrameContents& contents,
                                     bool native) {
    if (list.overlays.empty() && !draws_overlay(frame, contents)) return nullptr;
    targets_.add_overlay();
    if (native) {
        targets_.overlay.write(frame.whole());
        std::ranges::fill(targets_.overlay.pixels<std::byte>(), std::byte{0});
    } else {
        const float nothing[4] = {0, 0, 0, 0};
        targets_.display().clear_color(0, nothing);
    }
    draw_overlay_items(frame, list, native);
    LitPicture lit{.overlay = &targets_.overlay, .covered = frame.covered};
    draw_effects(frame, list, {.native = native, .overlay_only = true}, lit);
    if (contents.custom && !native)
        contents.custom->draw(Stage::overlay, frame, targets_, targets_.overlay.drawn(), timer_);
    return &targets_.overlay;
}

const Box3d& Pipeline::bounds_of(const SceneSnapshot& scene) {
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

void Pipeline::evict_unused() {
    caches_.evict_unused();
    for (const auto& kind : primitives_) kind->evict_unused();
}

}  // namespace easypbr::render
