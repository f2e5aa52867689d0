// Textures copied into CUDA memory, on the GPU. The driver's library (libcuda.so.1) is looked for when it is
// asked for: neither the build nor the program needs CUDA.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "easypbr/gl/texture.h"

namespace easypbr::gl {

/// The CUDA device that the current context draws on; nothing when there is no driver of CUDA's, or when the
/// context is another driver's.
std::optional<int> cuda_device();

/// Pixels in the memory of a CUDA device, row 0 first, tightly packed, in the layout that
/// Framebuffer::read() has. Freed with the object, on any thread.
class CudaPixels {
  public:
    CudaPixels(CudaPixels&& other) noexcept { swap(other); }
    CudaPixels& operator=(CudaPixels&& other) noexcept {
        swap(other);
        return *this;
    }
    ~CudaPixels();

    uint64_t address() const { return address_; }
    int device() const { return device_; }
    int width() const { return width_; }
    int height() const { return height_; }
    Format format() const { return format_; }

  private:
    friend CudaPixels copy_to_cuda(const Texture& texture);
    CudaPixels() = default;
    void swap(CudaPixels& other) noexcept {
        std::swap(address_, other.address_);
        std::swap(device_, other.device_);
        std::swap(width_, other.width_);
        std::swap(height_, other.height_);
        std::swap(format_, other.format_);
    }

    uint64_t address_ = 0;
    int device_ = 0, width_ = 0, height_ = 0;
    Format format_ = Format::rgba8;
};

/// Copies level 0 of a flat texture. What was drawn into it before is finished first, and the copy is
/// complete when this returns. Throws ContextError when cuda_device() is nothing, and with the driver's own
/// words when it fails (no memory, for instance).
CudaPixels copy_to_cuda(const Texture& texture);

}  // namespace easypbr::gl
