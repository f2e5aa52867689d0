// Point clouds on the device: 20 bytes per point, 16 without normals.
#pragma once

#include <tuple>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::render {

struct PointBuffers {
    gl::Buffer positions;  ///< 3 floats
    gl::Buffer normals;    ///< octahedral, 2 x 16 bits; absent without N
    gl::Buffer colors;     ///< RGBA8, sRGB-encoded; absent without C
    gl::VertexArray array;
};

/// Buffers by the revisions of the arrays they were made from.
class PointCache {
  public:
    const PointBuffers& get(const MeshData& mesh);

    /// Drops what was not asked for since the last call.
    void evict_unused() { buffers_.evict_unused(); }

  private:
    using Key = std::tuple<uint64_t, uint64_t, uint64_t>;
    RevisionCache<Key, PointBuffers> buffers_;
};

}  // namespace easypbr::render
