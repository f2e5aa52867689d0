// Where a camera sees from: a point, or a direction.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/camera.h"

namespace easypbr {

struct Eye {
    bool is_perspective = true;
    Vec3d position{0, 0, 0};
    Vec3d backward{0, 0, 1};  ///< unit, against the optical axis
    double near = 0;          ///< depth along the optical axis; nothing nearer is seen

    explicit Eye(const Camera& camera)
        : is_perspective(camera.projection == Projection::perspective),
          position(camera.position()),
          backward(camera.T_world_cam.linear().col(2)),
          near(camera.near) {}

    /// From a point to the viewer, not normalised for a perspective camera.
    Vec3d towards(const Vec3d& point) const { return is_perspective ? Vec3d(position - point) : backward; }
    double depth(const Vec3d& point) const { return (position - point).dot(backward); }
};

}  // namespace easypbr
