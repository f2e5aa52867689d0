#include "easypbr/render/primitives/points/point_splats.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {
namespace {

/// Least diameter of automatic splats, in pixels of a picture 1080 high.
constexpr double least_pixels_at_1080 = 1.5;
/// The same where all points are at one place: there is no spacing, and nothing else to see.
constexpr double lonely_pixels_at_1080 = 12;

}  // namespace

PointSplats splats_of(const DrawItem& item, const Frame& frame, double spacing) {
    const DrawStyle& style = item.style;
    // clip_from_view(1, 1) / w is the height in half pictures of one unit of length.
    const double pixels_per_unit = frame.clip_from_view(1, 1) * frame.size.y() / 2;
    PointSplats splats;
    splats.clip_from_mesh =
        (frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix()).cast<float>();
    splats.round = style.point_shape == PointShape::round;
    const double world = !style.point_size ? spacing * spacings_per_splat * item.scale()
                         : style.point_size_unit == SizeUnit::world ? double(*style.point_size)
                                                                    : 0.0;
    splats.world_pixels = float(world * pixels_per_unit);
    const double least = spacing > 0 ? least_pixels_at_1080 : lonely_pixels_at_1080;
    splats.least_pixels = style.point_size ? 1 : float(std::max(1.0, least * frame.picture_size.y() / 1080));
    splats.pixels = style.point_size && world == 0 ? *style.point_size : splats.least_pixels;
    splats.is_drawn = drawn_vertices(item);
    return splats;
}

}  // namespace easypbr::render
