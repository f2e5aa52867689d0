// Cameras and camera paths to look at.
#pragma once

#include <optional>

#include "easypbr/core/image.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/camera_path.h"
#include "easypbr/scene/mesh.h"

namespace easypbr {

/// Edges from the camera's position to the corners of its picture of size (width, height), laid at `depth`
/// along the optical axis, with a roof over the upper border that says where up is. The vertices are in the
/// camera's frame (it looks along -z) and T_parent_mesh is its pose. An image that is not empty becomes the
/// child "image": an unlit textured rectangle that fills the picture's outline, upright for who stands where
/// the camera does. Of an orthographic camera the edges are parallel. Throws ArgumentError unless depth and
/// size are above 0.
Mesh make_camera_frustum(const Camera& camera, const Vec2i& size, double depth = 1, const Image& image = {});

/// The same from OpenCV's intrinsic matrix (pixel centres at integers) and pose (x right, y down, z forward)
/// for pictures of that size. Throws ArgumentError when K or the pose is not valid.
Mesh make_camera_frustum(const Mat3d& K, const Mat4d& T_world_cam, const Vec2i& size, double depth = 1,
                         const Image& image = {});

/// The path's curve as line segments, 32 for each stretch between two keys, with the outlines of its cameras
/// (make_camera_frustum()) as children: one at each key, twelve on an orbit. Pictures have the given size and
/// angle of view (the path's own where it has one); their frusta are `depth` long, by default a tenth of the
/// curve's extent. Throws ArgumentError unless size and depth are above 0.
Mesh make_camera_path(const CameraPath& path, const Vec2i& size = {4, 3}, double fov_y_deg = 30,
                      std::optional<double> depth = std::nullopt);

}  // namespace easypbr
