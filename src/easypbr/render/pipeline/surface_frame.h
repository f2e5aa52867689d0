// What the centres of the pixels see, and of which object it is: what ground truth is derived from.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/scene/camera.h"
#include "easypbr/scene/scene.h"

namespace easypbr::render {

/// What shape tells more of the vertices of an object than the depth that was drawn of them.
enum class VertexShape {
    none,
    disc,  ///< flat, about the vertex
    splat  ///< a Gaussian, seen where it is densest along the ray
};

/// Never anti-aliased, blended or filtered; row 0 on top. A blended surface stands where it is half opaque or
/// more.
struct SurfaceFrame {
    Vec2i size{0, 0};
    Camera camera;
    std::vector<float> depth;       ///< distance along the optical axis, 0 where there is nothing
    std::vector<uint32_t> object;   ///< 1 + place in `scene`, 0 where there is nothing
    std::vector<uint32_t> element;  ///< 1 + index of the face in the object's own data, or of the
                                    ///< vertex: of a voxel the first one in it
    std::vector<uint8_t> is_face;   ///< 1: the element is a face; else a vertex, of a voxel too
    std::vector<uint32_t> part;     ///< of faces, index into MeshData::parts; 0 of all else
    SceneSnapshot scene;            ///< with the objects' own data
    std::vector<bool> only_faces;   ///< for each object: nothing of it reaches beyond its vertices
    /// For each object: the edge of its voxels in the units of V, 0: it has none.
    std::vector<double> voxel_sizes;
    std::vector<VertexShape> vertex_shapes;  ///< for each object
};

}  // namespace easypbr::render
