// Surfels on the device: 44 bytes each.
#pragma once

#include <tuple>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::render {

struct SurfelBuffers {
    gl::Buffer positions;   ///< 3 floats
    gl::Buffer normals;     ///< 3 floats: zero has a meaning
    gl::Buffer axes;        ///< tangent, bitangent length
    gl::Buffer colors;      ///< RGBA8, sRGB-encoded; absent without C
    gl::VertexArray array;  ///< one instance per surfel
};

/// Buffers by the revisions of the arrays they were made from.
class SurfelCache {
  public:
    /// Of a mesh with normals.
    const SurfelBuffers& get(const MeshData& mesh);

    /// Drops what was not asked for since the last call.
    void evict_unused() { buffers_.evict_unused(); }

  private:
    using Key = std::tuple<uint64_t, uint64_t, uint64_t, uint64_t, uint64_t>;
    RevisionCache<Key, SurfelBuffers> buffers_;
};

}  // namespace easypbr::render
