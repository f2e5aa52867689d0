#include "easypbr/scene/motion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace easypbr {
namespace {

double mix(double from, double to, double t) {
    return from + (to - from) * t;
}

Mat3d rotation_between(const Mat3d& from, const Mat3d& to, double t) {
    return Eigen::Quaterniond(from).slerp(t, Eigen::Quaterniond(to)).normalized().toRotationMatrix();
}

/// A rotation times a stretch.
struct Turned {
    Mat3d rotation, stretch;

    explicit Turned(const Mat3d& linear) {
        Eigen::Affine3d(linear).computeRotationScaling(&rotation, &stretch);
    }
};

/// How what hangs from a node goes with it, in the world.
struct Carried {
    Eigen::Affine3d from_now = Eigen::Affine3d::Identity();  ///< from where it is to where it was
    std::optional<Eigen::Affine3d> replaced;  ///< from where it was known to have been; none: it was there
};

/// Where there is no inverse: `otherwise`.
Eigen::Affine3d change(const Eigen::Affine3d& from, const Eigen::Affine3d& to,
                       const Eigen::Affine3d& otherwise) {
    if (!(std::abs(from.linear().determinant()) >= 1e-30)) return otherwise;
    return to * from.inverse(Eigen::Affine);
}

/// From where a mesh is to where it was: it does not depend on the scene's origin.
Eigen::Affine3d change_in_world(const Mesh& mesh, const Eigen::Affine3d& moved) {
    if (moved.matrix() == Eigen::Matrix4d::Identity()) return moved;
    const Eigen::Affine3d now = mesh.T_world_mesh();
    return change(now, now * moved, Eigen::Affine3d::Identity());
}

Mat3d linear_between(const Mat3d& from, const Mat3d& to, double t) {
    const double from_sign = from.determinant(), to_sign = to.determinant();
    // What becomes its own mirror image is flat in between: no rotation leads there.
    if (from_sign * to_sign < 0) return from + (to - from) * t;
    // The stretch of a mirrored pose would be negative along an axis that differs from pose to pose. The
    // negative of the pose is not mirrored.
    const double sign = from_sign < 0 || to_sign < 0 ? -1 : 1;
    const Turned a(sign * from), b(sign * to);
    return sign * rotation_between(a.rotation, b.rotation, t) * (a.stretch + (b.stretch - a.stretch) * t);
}

}  // namespace

Motion::Motion(const SceneSnapshot& scene, const Camera& camera)
    : camera(camera), objects(object_keys(scene)) {
    poses.reserve(objects.size());
    for (const SceneSnapshot::Object& object : scene.objects) poses.push_back(object.T_world_mesh);
}

std::vector<Eigen::Affine3d> Motion::poses_before(const SceneSnapshot& scene) const {
    const std::vector<std::optional<size_t>> known = partners(object_keys(scene), objects);
    std::vector<Eigen::Affine3d> before;
    before.reserve(known.size());
    for (size_t i = 0; i < known.size(); ++i)
        before.push_back(known[i] ? poses[*known[i]] : scene.objects[i].T_world_mesh);
    return before;
}

void Motion::replace(const SceneSnapshot& scene, const MovedMeshes& moved) {
    const std::vector<Eigen::Affine3d> known = poses_before(scene);
    objects = object_keys(scene);
    poses.clear();
    poses.reserve(objects.size());
    std::map<uint64_t, Carried> carried;  // by children
    for (size_t i = 0; i < objects.size(); ++i) {
        const SceneSnapshot::Object& object = scene.objects[i];
        const auto parent = carried.find(object.node);
        const Carried above = parent == carried.end() ? Carried() : parent->second;
        const auto own =
            std::ranges::find(moved, object.node, [](const auto& mesh) { return mesh.first.identity(); });
        Eigen::Affine3d before = above.replaced ? *above.replaced * known[i] : known[i];
        if (own != moved.end()) {
            before = above.from_now * change_in_world(own->first, own->second) * object.T_world_mesh;
        }
        Carried below{change(object.T_world_mesh, before, above.from_now), {}};
        if (own != moved.end() || above.replaced)
            below.replaced = change(known[i], before, above.replaced.value_or(Eigen::Affine3d::Identity()));
        for (const Mesh& child : object.mesh->children) carried[child.identity()] = below;
        poses.push_back(before);
    }
}

Eigen::Affine3d between(const Eigen::Affine3d& from, const Eigen::Affine3d& to, double t) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    result.linear() = linear_between(from.linear(), to.linear(), t);
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
        // In the units of the second picture: exactly as they are where those are the first one's.
        const double x = double(l.width) / k.width, y = double(l.height) / k.height;
        camera.intrinsics = {mix(k.fx * x, l.fx, t),
                             mix(k.fy * y, l.fy, t),
                             mix(k.cx * x + 0.5 * (x - 1), l.cx, t),
                             mix(k.cy * y + 0.5 * (y - 1), l.cy, t),
                             l.width,
                             l.height,
                             mix(k.skew * x, l.skew, t)};
    }
    return camera;
}

}  // namespace easypbr
