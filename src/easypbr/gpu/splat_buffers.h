// Gaussian splats on the device: 44 bytes each and 6 for each harmonic's red, green and blue.
#pragma once

#include <cstdint>
#include <tuple>

#include "easypbr/core/revision_cache.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::gpu {

/// As shaders/splat_project.comp reads them.
struct SplatBuffers {
    gl::Buffer means;      ///< 3 floats each
    gl::Buffer shapes;     ///< semi-axes, quaternion w x y z, opacity: 8 floats
    gl::Buffer harmonics;  ///< 16-bit floats, of an even number for each splat
    uint32_t count = 0;
    int degree = 0;
    Vec3 centre{0, 0, 0};  ///< where most means are: matrices of floats are exact around it
};

/// Bytes of the largest of the buffers.
size_t largest_splat_buffer(const MeshData& mesh, bool with_colors);

/// Buffers by the revisions of the arrays they were made from.
class SplatBufferCache {
  public:
    /// `with_colors`: C in place of the harmonics.
    const SplatBuffers& get(const MeshData& mesh, bool with_colors);
    /// Drops what was not asked for since the last call.
    void evict_unused() { buffers_.evict_unused(); }

  private:
    using Key = std::tuple<uint64_t, uint64_t, uint64_t, uint64_t, uint64_t>;
    RevisionCache<Key, SplatBuffers> buffers_;
};

}  // namespace easypbr::gpu
