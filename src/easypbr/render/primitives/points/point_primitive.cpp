#include "easypbr/render/primitives/points/point_primitive.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/primitives/points/point_splats.h"
#include "easypbr/render/primitives/points/point_surface.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Points of more pixels are none to drivers: the centres of half of them may lie outside of a tile.
constexpr int largest_point = 256;

bool is_blended(const DrawItem& item) {
    return item.alpha == AlphaMode::blend;
}

}  // namespace

bool PointPrimitive::is_native(DrawItems items) const {
    return std::ranges::none_of(items, is_blended);
}

bool PointPrimitive::rasterise(const Frame& frame, DrawItems items, ExtensionSet, VisibleSurfaces& surfaces) {
    if (surfaces.buffer().takes_backs()) return true;
    const auto rank = [&](uint32_t id) { return surfaces.rank(id); };
    for (const DrawItem& item : items) {
        const Array3f& V = item.mesh().V;
        if (!surfaces.has_room(V.rows())) return false;
        PointSplats splats = splats_of(item, frame, spacings_);
        const PointOrder order = batches_.draw(item.mesh(), item.with_colors);
        splats.batches = order.batches;
        const uint32_t first =
            surfaces.add(item, uint32_t(V.rows()), std::make_unique<PointSurface>(item, frame, order));
        surfaces.buffer().draw_points(V, splats, first, rank);
    }
    return true;
}

bool PointPrimitive::cover(const Frame& frame, DrawItems items, std::span<uint8_t> covered) {
    const auto has_holes = [](const DrawItem& item) { return is_blended(item) || item.material.shader; };
    if (std::ranges::any_of(items, has_holes) || frame.resolved->settings.points.hole_filling > 0)
        return false;
    VisibleSurfaces surfaces;
    surfaces.clear(frame.size, frame.whole());
    if (!rasterise(frame, items, 0, surfaces)) return false;
    const auto pixels = surfaces.buffer().pixels();
    for (size_t i = 0; i < covered.size(); ++i) covered[i] |= uint8_t(pixels[i] != 0);
    return true;
}

ShadowShape PointPrimitive::shadow_shape(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    return {{mesh.V.revision(), mesh.N.revision(), uint64_t(item.style.point_shape), uint64_t(item.kind)},
            {shadows_.radius(item), 1}};
}

ScreenReach PointPrimitive::screen_reach(const Frame& frame, const DrawItem& item) {
    const PointSplats splats = splats_of(item, frame, spacings_);
    const double pixels_per_unit = frame.clip_from_view(1, 1) * frame.size.y() / 2;
    return {double(splats.world_pixels) / pixels_per_unit / 2,
            double(std::max(splats.pixels, splats.least_pixels)) / 2};
}

int PointPrimitive::reach_in_pixels(const DrawStyle& style) const {
    if (style.mode != DrawMode::points && !style.show_points) return 0;
    const bool in_pixels = style.point_size && style.point_size_unit == SizeUnit::pixels;
    const float size = in_pixels ? std::min(*style.point_size, float(largest_point)) : float(largest_point);
    return int(std::ceil(size / 2));
}

}  // namespace easypbr::render
