// Surfaces of revolution: a profile turned about the y axis.
#pragma once

#include <string>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

/// A point of a profile in the half plane of radius and y. The profile runs so that the outside is on its
/// left, as from top to bottom along a ball.
struct ProfilePoint {
    double radius, y;
    Vec2d normal;  ///< unit, outwards, in the same half plane
    double v = 0;
};

/// Sets v to 1 at the first point, 0 at the last and linear in the length between.
void set_v_by_length(std::vector<ProfilePoint>& profile);

/// Rings of segments + 1 vertices, one for each point. Two points at the same place make a hard edge; at
/// radius 0 a ring's vertices coincide, each with the normal and the u of the middle of its triangle.
MeshData revolve(const std::string& name, const std::vector<ProfilePoint>& profile, int segments);

}  // namespace easypbr::geometry
