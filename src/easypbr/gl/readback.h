// Readback: pixels on their way from a framebuffer to memory, while the driver goes on drawing.
#pragma once

#include <cstddef>
#include <span>

#include "easypbr/gl/object.h"
#include "easypbr/gl/texture.h"

namespace easypbr::gl {

/// A pixel buffer object and the fence behind the copy into it. May be used again and again: the buffer stays
/// while what is read has the same number of bytes.
class Readback {
  public:
    Readback() = default;

    /// Has a rectangle of color attachment `index` copied, rows as they lie in the texture, as it is after
    /// all commands so far: what is drawn later does not change it. Whatever was on its way before is given
    /// up. Throws ContextError when the memory cannot be had.
    void begin(const Framebuffer& from, unsigned index, Format format, int x, int y, int width, int height);
    /// Something is on its way.
    bool is_pending() const { return bool(fence_); }
    /// The fence has passed: finish() does not wait.
    bool is_done() const;
    /// Copies the pixels out; waits for the driver where the fence has not passed. `pixels` holds
    /// width * height * pixel_bytes(format). Throws ArgumentError when nothing is on its way or `pixels` has
    /// another size, ContextError when the driver gives nothing back.
    void finish(std::span<std::byte> pixels);

  private:
    Object buffer_, fence_;
    size_t size_ = 0;
};

}  // namespace easypbr::gl
