// Mesh data on the device.
#pragma once

#include <tuple>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::render {

/// Locations of the vertex attributes, as in shaders/geometry_mesh.vert.
enum AttributeLocation { position_location, normal_location, color_location, uv_location, tangent_location };

/// Triangles as the geometry pass draws them.
struct MeshBuffers {
    gl::Buffer positions;  ///< 3 floats
    gl::Buffer normals;    ///< octahedral, 2 x 16 bits: 0.004 degrees
    gl::Buffer colors;     ///< RGBA8, sRGB-encoded; absent without C
    gl::Buffer uvs;        ///< 2 floats; absent without UV
    gl::Buffer tangents;   ///< 4 x 16 bits; absent unless asked for
    gl::Buffer indices;    ///< 3 per face, 32 bits
    gl::VertexArray array;
    gpu::Winding winding = gpu::Winding::unknown;
    Box3d box;                  ///< of the vertices, when it is closed outward
    bool normals_agree = true;  ///< the winding tells the normals' side
};

/// Buffers by the revisions of the arrays they were made from.
class MeshCache {
  public:
    /// The buffers of a mesh with faces. Normals are computed where the mesh has none.
    const MeshBuffers& get(const MeshData& mesh, bool with_tangents);

    /// Drops what was not asked for since the last call.
    void evict_unused() { buffers_.evict_unused(); }

  private:
    using Key = std::tuple<uint64_t, uint64_t, uint64_t, uint64_t, uint64_t, uint64_t, bool>;
    RevisionCache<Key, MeshBuffers> buffers_;
};

}  // namespace easypbr::render
