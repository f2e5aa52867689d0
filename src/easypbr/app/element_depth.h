// How deep a pixel sees an element, in double precision: without the rasteriser's rounding, through a lens
// too.
#pragma once

#include <array>
#include <optional>

#include "easypbr/core/math.h"
#include "easypbr/render/pipeline/surface_frame.h"

namespace easypbr::app {

/// In the camera's frame, OpenCV's axes.
struct PixelRay {
    Vec3d origin, direction;  ///< origin.z is 0, direction.z is 1: the parameter is the depth
};

/// What was drawn at a pixel: through a lens the nearest drawn pixel's ray is another one than the pixel's.
struct DrawnPixel {
    double depth;
    std::optional<PixelRay> ray;
};

/// The depth at which a pixel's ray meets the plane of a face, whose corners are in the camera's frame; the
/// drawn depth where the face is seen edge-on or the pixel only touches it.
double depth_on_face(const std::array<Vec3d, 3>& corner, const PixelRay& ray, const DrawnPixel& drawn);

/// The depth at which a pixel's ray sees a vertex that is drawn as a disc, in its plane, or as a splat,
/// where it is densest; the drawn depth where a disc is seen edge-on or the pixel only touches it, and of
/// all else.
double depth_on_vertex(const render::SurfaceFrame& frame, size_t drawn_pixel,
                       const Eigen::Affine3d& T_cv_mesh, const PixelRay& ray, const DrawnPixel& drawn);

}  // namespace easypbr::app
