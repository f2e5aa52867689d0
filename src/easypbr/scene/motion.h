// Motion between two pictures: where camera and objects were at any time between.
#pragma once

#include <vector>

#include "easypbr/scene/animation.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/object_key.h"
#include "easypbr/scene/scene.h"

namespace easypbr {

/// Camera and poses of the picture before.
struct Motion {
    Camera camera;
    std::vector<ObjectKey> objects;
    std::vector<Eigen::Affine3d> poses;  ///< T_world_mesh of each

    Motion() = default;
    Motion(const SceneSnapshot& scene, const Camera& camera);

    /// Where the objects of a scene were, in their order. What was not there has not moved.
    std::vector<Eigen::Affine3d> poses_before(const SceneSnapshot& scene) const;
    /// These meshes moved so, in their parents' frames, whatever is known of before; what hangs from them
    /// goes with them. `scene`: where all is now.
    void replace(const SceneSnapshot& scene, const MovedMeshes& moved);
};

/// The pose at time t between two others, at 0 the first: the rotation turns evenly about one axis (slerp),
/// the shorter way; translation and stretching change linearly. So do mirrored poses. Between a pose and a
/// mirrored one all changes linearly.
Eigen::Affine3d between(const Eigen::Affine3d& from, const Eigen::Affine3d& to, double t);

/// The same for cameras: pose, angle of view or height, and intrinsics when both have them. Projection,
/// distortion and what is only in one are those of the second.
Camera between(const Camera& from, const Camera& to, double t);

}  // namespace easypbr
