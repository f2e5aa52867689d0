// Vertices and normals that follow joints and morph targets.
#pragma once

#include <vector>

#include "easypbr/scene/animation.h"

namespace easypbr {

/// Throws ArgumentError unless all arrays of a deformation fit together and every joint is one of the skin's.
void check_deformation(const Deformation& d, size_t joints, bool has_skin);

struct Deformed {
    Array3f::Dense V, N;
    Array4f::Dense uv_tangents;
};

/// The targets are added with their weights. Weighted sums of the joints' matrices, if there are any, then
/// move V; their cofactors turn N, as the inverse transpose does, so that the signs of tangents stay. Faces
/// of flat_F have their own normals. Targets do not turn tangents.
Deformed deformed(const Deformation& from, const std::vector<float>& weights,
                  const std::vector<Eigen::Affine3d>& T_mesh_joints);

}  // namespace easypbr
