// A camera and the point it turns about, and the ways a person moves them. Pure functions.
#pragma once

#include "easypbr/scene/pixel.h"

namespace easypbr::app {

/// Where a person looks from. The target lies on the optical axis, before the camera.
struct ViewPoint {
    Camera camera;
    Vec3d target{0, 0, 0};

    /// Distance of the target along the optical axis.
    double distance() const { return (target - camera.position()).norm(); }
};

/// Size of the world in one pixel at a depth along the optical axis, along x and y of the picture.
Vec2d pixel_pitch(const Camera& camera, Vec2i size, double depth);

/// Turns about the target: `right_deg` about the world's up axis, counter-clockwise seen from above, then
/// `up_deg` about the picture's horizontal, which stops short of looking straight along the axis. The
/// distance and the roll stay.
ViewPoint orbited(const ViewPoint& view, const Vec3d& up, double right_deg, double up_deg);

/// Moves in the picture's plane so that what is at the target's depth moves by `pixels` (x right, y down).
ViewPoint panned(const ViewPoint& view, Vec2d pixels, Vec2i size);

/// Scales all distances about a point, which stays at its pixel: below 1 goes nearer.
ViewPoint zoomed(const ViewPoint& view, double factor, const Vec3d& about);

/// Moves along the camera's own axes, target and all: x right, y up, z forward, world units.
ViewPoint flown(const ViewPoint& view, const Vec3d& by);

/// Makes a point the target and the middle of the picture; direction and distance stay.
ViewPoint focused(const ViewPoint& view, const Vec3d& point);

}  // namespace easypbr::app
