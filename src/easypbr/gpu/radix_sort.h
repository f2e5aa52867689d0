// Sorting in buffers of the device.
#pragma once

#include <cstdint>

#include "easypbr/gl/buffer.h"
#include "easypbr/gl/program.h"

namespace easypbr::gpu {

/// Sorts 32-bit keys from the lowest to the highest, and 32-bit values with them; of equal keys the order
/// stays. Compute shaders; the context is current.
class RadixSort {
  public:
    /// Both hold at least `count` values.
    void run(const gl::Buffer& keys, const gl::Buffer& values, uint32_t count);

  private:
    gl::Program count_, sum_, move_;
    gl::Buffer other_keys_, other_values_, counts_, totals_;
};

}  // namespace easypbr::gpu
