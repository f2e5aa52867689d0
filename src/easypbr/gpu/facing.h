// What may be said about the sides of a mesh's faces without drawing them.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/camera.h"

namespace easypbr::gpu {

/// Which way the faces of a mesh look.
enum class Winding {
    unknown,  ///< not found out, or faces of it look different ways
    open,     ///< it has a boundary: some edge has an odd number of faces
    outward,  ///< every connected component is closed and its faces look outward
    inward    ///< the same the other way round
};

/// Vertices at one place count as one, so that creases and seams of texture coordinates do not open a mesh.
/// Constant memory per vertex, two passes over the faces for an open mesh.
Winding winding_of(const Array3f& V, const Array3i& F);

/// Back faces are never seen from outside then, and leaving them out changes no picture.
inline bool is_closed_outward(const Array3f& V, const Array3i& F) {
    return winding_of(V, F) == Winding::outward;
}

/// True when every given vertex normal is on the same side as the winding of the faces around it.
bool normals_agree_with_winding(const Array3f& V, const Array3f& N, const Array3i& F);

/// The box of the vertices, without coordinates that are not numbers.
Box3d box_of(const Array3f& V);

/// Whether all of a box lies before the camera, beyond its near plane. Else the camera may be within what the
/// box holds, or the near plane may cut it open: the back faces of a closed mesh may be seen.
bool beyond_near_plane(const Camera& camera, const Eigen::Affine3d& T_world_mesh, const Box3d& box);

}  // namespace easypbr::gpu
