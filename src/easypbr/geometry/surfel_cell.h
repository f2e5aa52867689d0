// How large a surfel must be: the part of its tangent plane that is nearest to it.
#pragma once

#include <span>
#include <vector>

#include "easypbr/core/math.h"

namespace easypbr::geometry {

/// Semi-axes of an ellipse, perpendicular to each other and to the normal; the second is normal x direction
/// of first.
struct SurfelAxes {
    Vec3d first;
    double second;
};

/// Any unit vector perpendicular to a unit vector; continuous but for one direction (Duff et al. 2017,
/// Building an Orthonormal Basis, Revisited).
Vec3d perpendicular(const Vec3d& normal);

/// The smallest ellipse in the tangent plane that covers the plane's part which is nearer to the surfel than
/// to any of the others (its cell in their restricted Voronoi diagram). So surfels on a plane cover it
/// without holes, whatever the pattern of the points; `reach` is how far the cell is looked at. Where nothing
/// bounds the cell within it, at the border of the surface or of a gap wider than that, it ends as far away
/// as its farthest corner between two neighbours. `steps` are the others' positions relative to the surfel,
/// none of them zero.
SurfelAxes covering_axes(const Vec3d& normal, std::span<const Vec3d> steps, double reach);

}  // namespace easypbr::geometry
