#include "easypbr/render/primitives/points/point_splats.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {
namespace {

/// Least diameter of automatic splats, in pixels of a picture 1080 high.
constexpr double least_pixels_at_1080 = 1.5;
/// The same where they leave holes: each is to be seen.
constexpr double least_sparse_pixels_at_1080 = 12;
/// Diameter of a lone point, whatever its distance.
constexpr double lone_pixels_at_1080 = 18, least_lone_pixels = 8;

/// Sets the size of splats whose size is inferred. `pixels_per_unit`: of one unit of V, times w.
void infer_size(PointSplats& splats, const AutomaticDiscs& discs, double pixels_per_unit, double height) {
    const auto scaled = [&](double at_1080, double least) {
        return std::max(least, at_1080 * height / 1080);
    };
    double least = scaled(least_pixels_at_1080, 1);
    if (!(discs.diameter > 0)) {
        least = scaled(lone_pixels_at_1080, least_lone_pixels);
    } else if (discs.least > 0) {
        // Not more than what closes the holes, where the cloud is small in the picture.
        const double w = (splats.clip_from_mesh * discs.centre.homogeneous().cast<float>()).w();
        const double seen = scaled(least_sparse_pixels_at_1080, 1) * discs.least;
        least = std::max(least, w > 0 ? std::min(seen, discs.closing * pixels_per_unit / w) : seen);
    }
    splats.world_pixels = float(discs.diameter * pixels_per_unit);
    splats.pixels = splats.least_pixels = float(least);
}

}  // namespace

PointSplats splats_of(const DrawItem& item, const Frame& frame, SpacingCache& spacings) {
    const DrawStyle& style = item.style;
    // clip_from_view(1, 1) / w is the height in half pictures of one unit of length.
    const double pixels_per_unit = frame.clip_from_view(1, 1) * frame.size.y() / 2;
    PointSplats splats;
    splats.is_drawn = drawn_vertices(item);
    splats.clip_from_mesh =
        (frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix()).cast<float>();
    splats.round = style.point_shape == PointShape::round;
    if (!style.point_size) {
        infer_size(splats, spacings.discs(item.mesh().V), item.scale() * pixels_per_unit,
                   frame.picture_size.y());
        return splats;
    }
    const bool in_world = style.point_size_unit == SizeUnit::world;
    splats.world_pixels = in_world ? float(double(*style.point_size) * pixels_per_unit) : 0.0f;
    splats.least_pixels = 1;
    splats.pixels = in_world ? 1 : *style.point_size;
    return splats;
}

}  // namespace easypbr::render
