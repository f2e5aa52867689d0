// The colour of a splat from a direction: real spherical harmonics up to degree 3.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/render/drawables/draw_list.h"

namespace easypbr::render {

/// sRGB-encoded, 0 or more. `sh` holds (degree + 1)^2 times red, green, blue (see SplatArrays::sh);
/// `direction` is a unit vector from the camera to the splat in the frame of the splats. Basis and signs are
/// those of Kerbl et al. 2023.
Vec3 splat_color(const float* sh, int degree, const Vec3& direction);

/// The colour of a splat of an item, sRGB-encoded, to a ray of this unit direction in the world.
Vec3 splat_color(const DrawItem& item, Eigen::Index splat, const Vec3& direction);

}  // namespace easypbr::render
