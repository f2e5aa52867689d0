// Which place a camera sees at a pixel, and the other way round.
#pragma once

#include "easypbr/scene/camera.h"

namespace easypbr {

/// World position of what is seen at a pixel of a picture of `size` at a depth along the optical axis. Pixels
/// count from the picture's top left corner. The lens's distortion is taken out; beyond a fold of the lens it
/// is the pinhole's.
Vec3d point_at(const Camera& camera, Vec2d pixel, Vec2i size, double depth);

/// The pixel that a world position is seen at; x, y may lie outside of the picture. z is the depth along the
/// optical axis: what has none above 0 is behind a perspective camera. As the lens distorts it, where it
/// does.
Vec3d pixel_of(const Camera& camera, const Vec3d& point, Vec2i size);

}  // namespace easypbr
