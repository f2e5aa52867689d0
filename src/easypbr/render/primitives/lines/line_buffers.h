// Line segments on the device: 32 bytes each.
#pragma once

#include <tuple>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/gpu/line_segments.h"

namespace easypbr::render {

struct LineBuffers {
    gl::Buffer segments;
    gl::VertexArray array;  ///< one instance per segment
    int count = 0;
};

/// Buffers by the revisions of the arrays they were made from.
class LineCache {
  public:
    /// `length` is that of the normals.
    const LineBuffers& get(const MeshData& mesh, gpu::LineKind kind, float length);

    /// Drops what was not asked for since the last call.
    void evict_unused() { buffers_.evict_unused(); }

  private:
    using Key = std::tuple<uint64_t, uint64_t, uint64_t, uint64_t, uint64_t, gpu::LineKind, float>;
    RevisionCache<Key, LineBuffers> buffers_;
};

}  // namespace easypbr::render
