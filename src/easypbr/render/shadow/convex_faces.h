// The planes that bound convex meshes of few faces.
#pragma once

#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"

namespace easypbr::render {

/// The plane normal . p = offset of a unit normal; above it normal . p is larger.
struct FacePlane {
    Vec3d normal;
    double offset;
};

/// The planes of a closed convex mesh of 4 to 64 faces, which lies below all of them, or both sides of the
/// plane in which all faces of a mesh lie; none of other meshes. Vertices that no face has count.
std::vector<FacePlane> convex_faces(const Array3f& V, const Array3i& F);

}  // namespace easypbr::render
