// Line segments on the device: 44 bytes each.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/gpu/line_segments.h"

namespace easypbr::render {

struct LineBuffers {
    gl::Buffer segments;
    gl::VertexArray array;  ///< one instance per segment
    int count = 0;
};

/// Segments by the revisions of the arrays they were made from, on the device or in host memory.
class LineCache {
  public:
    /// `normal_length` is in the mesh's own units; nothing: by the size of the mesh.
    const LineBuffers& get(const MeshData& mesh, gpu::LineKind kind, std::optional<float> normal_length);
    const std::vector<gpu::Segment>& segments(const MeshData& mesh, gpu::LineKind kind,
                                              std::optional<float> normal_length);

    /// Drops what was not asked for since the last call.
    void evict_unused() {
        buffers_.evict_unused();
        segments_.evict_unused();
    }

  private:
    using Key = std::tuple<std::array<uint64_t, 8>, gpu::LineKind, std::optional<float>>;
    static Key key_of(const MeshData& mesh, gpu::LineKind kind, std::optional<float> normal_length);

    RevisionCache<Key, LineBuffers> buffers_;
    RevisionCache<Key, std::vector<gpu::Segment>> segments_;
};

}  // namespace easypbr::render
