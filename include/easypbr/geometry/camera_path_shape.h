// A camera path to look at: its curve, and the cameras on it.
#pragma once

#include <optional>

#include "easypbr/scene/camera_path.h"
#include "easypbr/scene/mesh.h"

namespace easypbr {

/// The path's curve as line segments, 32 for each stretch between two keys, with the outlines of its cameras
/// (make_camera_frustum()) as children: one at each key, twelve on an orbit. Pictures have the given size and
/// angle of view (the path's own where it has one); their frusta are `depth` long, by default a tenth of the
/// curve's extent. Throws ArgumentError unless size and depth are above 0.
Mesh make_camera_path(const CameraPath& path, const Vec2i& size = {4, 3}, double fov_y_deg = 30,
                      std::optional<double> depth = std::nullopt);

}  // namespace easypbr
