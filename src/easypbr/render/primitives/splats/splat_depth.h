// Where single splats are along rays, in double precision.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::render {

/// A ray in a camera's frame, whose third axis is the optical one: the parameter is the depth, and the same
/// as the third coordinate but for its sign.
struct DepthRay {
    Vec3d origin, direction;  ///< origin.z is 0, direction.z 1 or -1
};

/// The depth at which the Gaussian of a splat is densest along a ray: (d P m) / (d P d) from the ray's
/// origin, with the inverse covariance P and the mean m. It may be behind the camera. Rays that pass a splat
/// at more than some standard deviations, as those of a pixel do that is larger than the splat, get a depth
/// that the splat reaches.
double splat_depth(const MeshData& mesh, Eigen::Index splat, const Eigen::Affine3d& T_camera_mesh,
                   const DepthRay& ray);

}  // namespace easypbr::render
