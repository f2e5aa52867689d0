// Pictures between passes, which live in host memory or in a texture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/memory_pool.h"
#include "easypbr/core/picture.h"
#include "easypbr/gl/texture.h"

namespace easypbr::render {

using easypbr::PixelRect;

/// Copies of targets from one memory to the other.
struct Transfers {
    int uploads = 0, downloads = 0;
    int64_t uploaded_bytes = 0, downloaded_bytes = 0;

    void note_upload(size_t bytes) {
        ++uploads;
        uploaded_bytes += int64_t(bytes);
    }
    void note_download(size_t bytes) {
        ++downloads;
        downloaded_bytes += int64_t(bytes);
    }
    bool operator==(const Transfers&) const = default;
};

/// A picture between passes. Whoever writes it decides where: passes of the driver draw to its texture,
/// native passes write host memory. A pass that needs it elsewhere asks for a transfer, which is counted;
/// none takes place where the pixels are there already. In host memory a target holds a rectangle, and zeros
/// beyond it.
class Target {
  public:
    Target() = default;
    /// Takes no memory until one of the two is asked for.
    Target(gl::Format format, Vec2i size) : format_(format), size_(size) {}

    explicit operator bool() const { return size_.x() > 0; }
    gl::Format format() const { return format_; }
    Vec2i size() const { return size_; }
    int width() const { return size_.x(); }
    int height() const { return size_.y(); }
    PixelRect whole() const { return {0, 0, size_.x(), size_.y()}; }

    /// Reads the texture in shaders. Throws Error when newer pixels are in host memory.
    const gl::Texture& texture() const;
    void bind(unsigned unit) const { texture().bind(unit); }
    /// The texture to draw to; what host memory holds is out of date from now on.
    const gl::Texture& drawn() const;
    /// The texture, whatever it holds.
    const gl::Texture& attachment() const;

    /// Begins to write a rectangle in host memory, whose pixels are undefined; the texture is out of date.
    void write(const PixelRect& area) const;
    /// Whatever it holds is out of date.
    void forget() const { newest_ = Newest::texture; }
    /// Gives host memory back. What was there alone is lost.
    void release() const;
    /// The rectangle in host memory.
    const PixelRect& area() const { return area_; }
    /// Its pixels, row by row: all channels as values of T.
    template <class T>
    std::span<T> pixels() const {
        return {reinterpret_cast<T*>(host_.data()), host_.size() / sizeof(T)};
    }

    /// Whether host memory holds newer pixels than the texture.
    bool is_ahead() const { return newest_ == Newest::host; }
    /// Brings the rectangle in host memory to the texture, which keeps what it holds elsewhere.
    void upload(Transfers& transfers) const;
    /// The same to another texture, of as many bytes a pixel.
    void copy_to(const gl::Texture& texture, Transfers& transfers) const;
    /// Brings a rectangle of the texture to host memory, unless host memory holds it, or the whole picture
    /// (see area()), already.
    void download(const PixelRect& area, Transfers& transfers) const;
    /// The whole picture, wherever it is: all channels as values of T, row by row.
    template <class T>
    std::vector<T> read(Transfers& transfers) const {
        std::vector<T> values(size_t(size_.x()) * size_t(size_.y()) * gl::pixel_bytes(format_) / sizeof(T));
        read_to(std::as_writable_bytes(std::span(values)), transfers);
        return values;
    }

    /// A rectangle of what host memory holds, which is the newest.
    void copy_out(const PixelRect& area, std::span<std::byte> values) const;

  private:
    enum class Newest { both, host, texture };
    void read_to(std::span<std::byte> values, Transfers& transfers) const;

    gl::Format format_ = gl::Format::rgba8;
    Vec2i size_{0, 0};
    // A target is a handle: who holds it may draw to it.
    mutable gl::Texture texture_;
    mutable gl::Framebuffer reading_;
    mutable PooledVector<std::byte> host_;
    mutable PixelRect area_;
    mutable Newest newest_ = Newest::texture;
    mutable bool is_complete_ = false;  ///< beyond the rectangle in host memory the picture is zero
};

}  // namespace easypbr::render
