#include "easypbr/app/face_depth.h"

#include <algorithm>
#include <cmath>

namespace easypbr::app {
namespace {

/// How far the hit of the drawn pixel's ray may lie from the drawn depth, as a part of it: beyond, the face
/// is seen edge-on or the pixel only touches it.
constexpr double relative_depth_tolerance = 0.01;

}  // namespace

double depth_on_face(const std::array<Vec3d, 3>& corner, const PixelRay& ray, const DrawnPixel& drawn) {
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const auto depth_along = [&](const PixelRay& r) {
        const double slant = normal.dot(r.direction);
        return slant != 0 ? normal.dot(corner[0] - r.origin) / slant : drawn.depth;
    };
    const double tolerance = relative_depth_tolerance * drawn.depth;
    double depth = depth_along(drawn.ray.value_or(ray));
    if (!(std::abs(depth - drawn.depth) <= tolerance)) return drawn.depth;
    if (!drawn.ray) return depth;
    // Beside a face that is seen edge-on its plane is somewhere else.
    const auto [nearest, farthest] = std::minmax({corner[0].z(), corner[1].z(), corner[2].z()});
    depth = depth_along(ray);
    return depth >= nearest - tolerance && depth <= farthest + tolerance ? depth : drawn.depth;
}

}  // namespace easypbr::app
