// A camera to look at: where it stands, what it sees, and its picture.
#pragma once

#include "easypbr/core/image.h"
#include "easypbr/scene/camera.h"
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

}  // namespace easypbr
