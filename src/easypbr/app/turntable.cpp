#include <cmath>

#include "easypbr/app/recorder.h"
#include "easypbr/app/session.h"
#include "easypbr/scene/offset.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

/// What a thing sweeps out as it turns: a cylinder around `axis` through `center`.
struct Cylinder {
    Vec3d center, axis;
    double radius = 0, half_height = 0;
};

Cylinder swept(const SceneSnapshot& scene, const Vec3d& axis) {
    const Box3d box = scene.bounds();
    Cylinder swept{box.isEmpty() ? Vec3d(Vec3d::Zero()) : Vec3d(box.center()), axis};
    if (!box.isEmpty()) swept.half_height = std::abs(axis.dot(box.sizes())) / 2;
    for (const SceneSnapshot::Object& object : scene.objects)
        for (Eigen::Index i = 0; i < object.mesh->V.rows(); ++i) {
            const Vec3d arm =
                object.T_world_mesh * object.mesh->V.row(i).transpose().cast<double>() - swept.center;
            swept.radius = std::max(swept.radius, (arm - axis * axis.dot(arm)).norm());
        }
    return swept;
}

/// The distance from which a camera that looks at the cylinder's middle sees all of it: a point p (from the
/// middle, in the camera's axes) is in the picture from d >= |x| / tangent + z on.
double distance_for(const Cylinder& cylinder, const Mat3d& R_world_cam, const Vec2d& tangents) {
    constexpr int directions = 256;
    const Vec3d side = cylinder.axis.unitOrthogonal(), other = cylinder.axis.cross(side);
    double distance = 0;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2 * pi * i / directions;
        const Vec3d rim = cylinder.radius * (std::cos(angle) * side + std::sin(angle) * other);
        for (const double end : {-1.0, 1.0}) {
            const Vec3d p = R_world_cam.transpose() * (rim + end * cylinder.half_height * cylinder.axis);
            distance = std::max(
                {distance, std::abs(p.x()) / tangents.x() + p.z(), std::abs(p.y()) / tangents.y() + p.z()});
        }
    }
    return distance;
}

bool is_automatic(const CameraSettings& camera) {
    return camera.pose.empty() && !camera.position.is_pinned() && !camera.target.is_pinned() &&
           camera.projection == Projection::perspective && camera.intrinsics.empty();
}

}  // namespace

CameraPath turntable(Session& session, double duration_s) {
    const ResolvedSettings resolved = session.resolve();
    const Cylinder content = swept(session.scene().snapshot(), parse_up(resolved.settings.camera.up));
    Camera camera = resolved.camera;
    if (is_automatic(session.settings().camera) && content.radius + content.half_height > 0) {
        const Vec2i size = session.settings().image.size;
        const double tangent =
            std::tan(radians(camera.fov_y_deg) / 2) * (1 - double(resolved.settings.camera.margin));
        const double distance =
            distance_for(content, camera.T_world_cam.linear(), {tangent * size.x() / size.y(), tangent});
        camera.T_world_cam.translation() = content.center + camera.T_world_cam.linear().col(2) * distance;
    }
    return CameraPath::orbit(camera, content.center, content.axis, 360, duration_s);
}

}  // namespace easypbr::app
