// Motion between two pictures: where camera and objects were at any time between.
#pragma once

#include <map>
#include <string>

#include "easypbr/scene/camera.h"
#include "easypbr/scene/scene.h"

namespace easypbr {

/// Camera and poses of the picture before.
struct Motion {
    Camera camera;
    std::map<std::string, Eigen::Affine3d> poses;  ///< T_world_mesh by the object's name

    Motion() = default;
    Motion(const SceneSnapshot& scene, const Camera& camera);
};

/// The pose at time t between two others, at 0 the first: the rotation turns evenly about one axis (slerp),
/// the shorter way; translation and stretching change linearly.
Eigen::Affine3d between(const Eigen::Affine3d& from, const Eigen::Affine3d& to, double t);

/// The same for cameras: pose, angle of view or height, and intrinsics when both have them. Projection and
/// what is only in one are those of the second.
Camera between(const Camera& from, const Camera& to, double t);

}  // namespace easypbr
