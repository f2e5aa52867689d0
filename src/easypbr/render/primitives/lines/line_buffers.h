// Line segments on the device: 44 bytes each, and 8 where they are dashed.
#pragma once

#include <array>
#include <cstdint>
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
    Box3 box;  ///< of the segments

    /// Where dashes are along each segment, as dashes_of() tells; not needed for solid lines.
    void set_dashes(const std::vector<std::array<float, 2>>& dashes);

  private:
    gl::Buffer dashes_;
};

/// Segments by the revisions of the arrays they were made from, on the device or in host memory.
class LineCache {
  public:
    /// `normals` counts for LineKind::normals alone.
    LineBuffers& get(const MeshData& mesh, gpu::LineKind kind, const gpu::NormalLines& normals);
    const std::vector<gpu::Segment>& segments(const MeshData& mesh, gpu::LineKind kind,
                                              const gpu::NormalLines& normals);
    /// gpu::edge_chains().
    const std::vector<gpu::ChainStep>& chains(const MeshData& mesh);

    /// Drops what was not asked for since the last call.
    void evict_unused() {
        buffers_.evict_unused();
        segments_.evict_unused();
        chains_.evict_unused();
    }

  private:
    using Key = std::tuple<std::array<uint64_t, 8>, gpu::LineKind, gpu::NormalLines>;
    static Key key_of(const MeshData& mesh, gpu::LineKind kind, const gpu::NormalLines& normals);

    RevisionCache<Key, LineBuffers> buffers_;
    RevisionCache<Key, std::vector<gpu::Segment>> segments_;
    /// By how many vertices there are, and the edges.
    RevisionCache<std::array<uint64_t, 2>, std::vector<gpu::ChainStep>> chains_;
};

}  // namespace easypbr::render
