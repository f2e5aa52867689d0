// Meshes at places, and a calibrated camera that looks at them, for tests.
#pragma once

#include "easypbr/scene/camera.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::dataset {

inline Mesh moved(Mesh mesh, const Vec3d& by) {
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(by)));
    return mesh;
}

/// OpenCV's camera at the origin that looks along the world's -z, y up.
inline Camera opencv_camera(const Mat3d& K, Vec2i size) {
    Mat4d T = Mat4d::Identity();
    T.topLeftCorner<3, 3>() = Vec3d(1, -1, -1).asDiagonal();
    return Camera::from_opencv(K, T, size.x(), size.y());
}

inline Mat3d off_centre_K() {
    return (Mat3d() << 210, 0, 70.3, 0, 190, 41.9, 0, 0, 1).finished();
}

}  // namespace easypbr::dataset
