#include "easypbr/scene/motion.h"

#include <cmath>

namespace easypbr {
namespace {

double mix(double from, double to, double t) {
    return from + (to - from) * t;
}

Mat3d rotation_between(const Mat3d& from, const Mat3d& to, double t) {
    return Eigen::Quaterniond(from).slerp(t, Eigen::Quaterniond(to)).normalized().toRotationMatrix();
}

}  // namespace

Motion::Motion(const SceneSnapshot& scene, const Camera& camera) : camera(camera) {
    const std::vector<ObjectKey> keys = object_keys(scene);
    for (size_t i = 0; i < keys.size(); ++i) poses[keys[i]] = scene.objects[i].T_world_mesh;
}

std::vector<Eigen::Affine3d> Motion::poses_before(const SceneSnapshot& scene) const {
    const std::vector<ObjectKey> keys = object_keys(scene);
    std::vector<Eigen::Affine3d> before;
    before.reserve(keys.size());
    for (size_t i = 0; i < keys.size(); ++i) {
        const auto known = poses.find(keys[i]);
        before.push_back(known == poses.end() ? scene.objects[i].T_world_mesh : known->second);
    }
    return before;
}

Eigen::Affine3d between(const Eigen::Affine3d& from, const Eigen::Affine3d& to, double t) {
    Mat3d from_rotation, from_stretch, to_rotation, to_stretch;
    from.computeRotationScaling(&from_rotation, &from_stretch);
    to.computeRotationScaling(&to_rotation, &to_stretch);
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    result.linear() =
        rotation_between(from_rotation, to_rotation, t) * (from_stretch + (to_stretch - from_stretch) * t);
    result.translation() = from.translation() + (to.translation() - from.translation()) * t;
    return result;
}

Camera between(const Camera& from, const Camera& to, double t) {
    Camera camera = to;
    const Vec3d a = from.position(), b = to.position();
    camera.T_world_cam.linear() = rotation_between(from.T_world_cam.linear(), to.T_world_cam.linear(), t);
    camera.T_world_cam.translation() = a + (b - a) * t;
    if (from.projection != to.projection) return camera;
    camera.fov_y_deg = mix(from.fov_y_deg, to.fov_y_deg, t);
    camera.ortho_height = mix(from.ortho_height, to.ortho_height, t);
    if (from.intrinsics && to.intrinsics) {
        const Intrinsics &k = *from.intrinsics, &l = *to.intrinsics;
        // In the units of the second picture.
        const double x = double(l.width) / k.width, y = double(l.height) / k.height;
        camera.intrinsics = {mix(k.fx * x, l.fx, t),
                             mix(k.fy * y, l.fy, t),
                             mix((k.cx + 0.5) * x - 0.5, l.cx, t),
                             mix((k.cy + 0.5) * y - 0.5, l.cy, t),
                             l.width,
                             l.height};
    }
    return camera;
}

}  // namespace easypbr
