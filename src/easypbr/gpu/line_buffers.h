// Line segments on the device: 32 bytes each.
#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "easypbr/gl/buffer.h"
#include "easypbr/gpu/line_segments.h"

namespace easypbr::gpu {

struct LineBuffers {
    gl::Buffer segments;
    gl::VertexArray array;  ///< one instance per segment
    int count = 0;
};

/// Buffers by the revisions of the arrays they were made from.
class LineCache {
  public:
    /// `length` is that of the normals.
    const LineBuffers& get(const MeshData& mesh, LineKind kind, float length);

    /// Drops what was not asked for since the last call.
    void evict_unused();

  private:
    using Key = std::tuple<uint64_t, uint64_t, uint64_t, uint64_t, uint64_t, LineKind, float>;
    struct Entry {
        std::unique_ptr<LineBuffers> buffers;
        bool used = false;
    };
    std::map<Key, Entry> entries_;
};

}  // namespace easypbr::gpu
