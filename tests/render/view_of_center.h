// Views of what stands around the origin, for tests of the rasterisers.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/camera.h"

namespace easypbr {

/// From a place towards the origin.
inline Camera camera_at(const Vec3d& eye, bool orthographic, double near = 0.05) {
    Camera camera = Camera::look_at(eye, Vec3d::Zero());
    camera.near = near;
    camera.far = 50;
    if (orthographic) camera.projection = Projection::orthographic;
    return camera;
}

/// From the world to the clip space of an image of that size.
inline Mat4 clip_from(const Camera& camera, Vec2i size) {
    return (camera.projection_matrix(double(size.x()) / size.y()) * camera.view()).cast<float>();
}

}  // namespace easypbr
