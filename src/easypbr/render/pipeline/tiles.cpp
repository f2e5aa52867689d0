#include "easypbr/render/pipeline/tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/render/denoise/edge_avoiding_filter.h"
#include "easypbr/render/effects/ambient_occlusion/ambient_occlusion_pass.h"
#include "easypbr/render/effects/effect.h"
#include "easypbr/render/effects/ground/ground_pass.h"
#include "easypbr/render/output/display_pass.h"
#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/raytrace/firefly_filter.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Beyond these many pixels occlusion and refraction are cut.
constexpr double most_reach = 1024, most_reach_beside_transmission = 512;
/// Smoothing along edges, the blur of occlusion.
constexpr int smallest_guard = 16;
/// Parts of one side of the picture.
struct Span {
    int inner, inner_end, outer, outer_end;
};

std::vector<Span> spans_of(int side, int guard, int limit) {
    if (side <= limit) return {{0, side, 0, side}};
    // The outer beginning is rounded down to the grid, which may take a grid step more.
    const int most = (limit - 2 * guard) / tile_grid * tile_grid - tile_grid;
    if (most < tile_grid)
        throw ArgumentError(
            fmt::format("a picture of {} pixels a side is drawn in tiles of {}, which leaves no room between "
                        "the {} pixels around each that its effects need to see; a single frame's depth "
                        "of field, bloom and transmission see farthest",
                        side, limit, guard));
    const int count = (side + most - 1) / most;
    const int step = (side + count * tile_grid - 1) / (count * tile_grid) * tile_grid;
    std::vector<Span> spans;
    for (int at = 0; at < side; at += step) {
        const int end = std::min(at + step, side);
        spans.push_back(
            {at, end, std::max(at - guard, 0) / tile_grid * tile_grid, std::min(end + guard, side)});
    }
    return spans;
}

bool has_transmission(const SceneSnapshot& scene, const ResolvedSettings& resolved) {
    if (const auto& set = resolved.settings.material.transmission; set.value()) return *set > 0;
    return std::ranges::any_of(scene.objects, [](const SceneSnapshot::Object& object) {
        return std::ranges::any_of(object.mesh->materials,
                                   [](const Material& m) { return m.transmission > 0; });
    });
}

/// How far what the scene shows reaches beyond its pixels.
int reach_in_pixels(const SceneSnapshot& scene, const ResolvedSettings& resolved) {
    DataCaches caches;
    const auto primitives = make_primitives(caches);
    int reach = 0;
    for (const auto& object : scene.objects) {
        DrawStyle style = resolve_style(*object.mesh, resolved.settings.style);
        style.mode = primitive_of(*object.mesh, style);
        for (const auto& kind : primitives)
            if (style.visible) reach = std::max(reach, kind->reach_in_pixels(style));
    }
    return reach;
}

}  // namespace

TileLimits TileLimits::of(const gl::ContextInfo& context) {
    TileLimits limits;
    limits.side = std::min({limits.side, context.max_texture_size, context.max_viewport});
    return limits;
}

Guard guard_of(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i picture) {
    const InferredSettings& settings = resolved.settings;
    const Box3d bounds = scene.bounds();
    const Shot shot{.resolved = &resolved, .size = picture, .picture_size = picture};
    const Frame whole = make_frame(shot, 0, resolved.camera, bounds, true);

    Guard guard;
    guard.pixels = smallest_guard + settings.points.hole_filling + reach_in_pixels(scene, resolved);
    guard.pixels += DisplayPass::reach(whole);
    const bool transmits = has_transmission(scene, resolved);
    if (const double reach = AmbientOcclusionPass::reach(whole, bounds); reach > 0) {
        // A ground comes as near to the camera as it likes.
        guard.reach = GroundPass::is_on(resolved) ? most_reach : std::min(reach, most_reach);
        if (transmits) guard.reach = std::min(guard.reach, most_reach_beside_transmission);
        guard.pixels += int(guard.reach);
    }
    if (transmits) {
        guard.reach = most_reach_beside_transmission;
        // What rough glass shows is blurred by a quarter of its reach, seen through twice as wide a filter.
        guard.pixels += int(1.5 * most_reach_beside_transmission);
    }
    if (resolved.traces_paths) guard.pixels += EdgeAvoidingFilter::reach + FireflyFilter::reach;
    for (const auto& effect : make_effects()) guard.pixels += effect->reach(whole, bounds);
    return guard;
}

std::vector<Tile> tiles_of(Vec2i picture, int guard, const TileLimits& limits) {
    if (picture.maxCoeff() <= limits.side && int64_t(picture.x()) * picture.y() <= limits.pixels) {
        const PixelRect all{0, 0, picture.x(), picture.y()};
        return {{all, all}};
    }
    const int limit = std::min(limits.side, int(std::sqrt(double(limits.pixels))));
    std::vector<Tile> tiles;
    for (const Span& y : spans_of(picture.y(), guard, limit))
        for (const Span& x : spans_of(picture.x(), guard, limit))
            tiles.push_back({{x.inner, y.inner, x.inner_end - x.inner, y.inner_end - y.inner},
                             {x.outer, y.outer, x.outer_end - x.outer, y.outer_end - y.outer}});
    return tiles;
}

}  // namespace easypbr::render
