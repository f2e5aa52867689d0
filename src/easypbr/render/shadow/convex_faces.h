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

/// Both sides of the plane in which all faces of a mesh lie; or the planes of a slab, which lies below all of
/// them: a closed convex mesh of at most 64 faces, at most 1/10 of its diagonal thick. None of other meshes.
/// Vertices that no face has count.
std::vector<FacePlane> convex_faces(const Array3f& V, const Array3i& F);

}  // namespace easypbr::render
