// Which side of a surface its normals point to.
#pragma once

#include <vector>

#include "easypbr/geometry/neighborhoods.h"

namespace easypbr::geometry {

/// Turns unit normals so that those of neighbours agree. The relation of two neighbours is that of a circular
/// arc through them, which also holds across sharp edges and between the sides of thin walls: the normal of
/// one mirrored in the plane half way between them (Xie, Wang, Hua, Qin and Kaufman 2003). It is handed on
/// along the minimum spanning tree of the neighbourhood graph, most certain relations first (Hoppe et al.
/// 1992). Then each connected piece faces outwards when it is closed; an open one faces the positive side of
/// the axis that its mean normal is nearest to, so that ground faces up.
void orient_consistently(std::vector<Vec3>& normals, const Neighborhoods& neighborhoods);

/// Turns every normal towards the viewpoint.
void orient_towards(std::vector<Vec3>& normals, const Neighborhoods& neighborhoods, const Vec3d& viewpoint);

}  // namespace easypbr::geometry
