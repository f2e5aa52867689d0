// Textures and framebuffers.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <vector>

#include "easypbr/gl/object.h"

namespace easypbr::gl {

enum class Format {
    r8,
    rg8,
    rgba8,
    srgb8_alpha8,
    rg16,
    r16,
    rgba16,
    r32f,
    r16f,
    rgba16f,
    rgba32f,
    rg16f,
    r32ui,
    rgba32ui,
    depth32f
};

/// Bytes of one pixel as upload() and read() take it (16-bit floats are given as halves).
size_t pixel_bytes(Format format);

enum class TextureKind { flat, cube, array };
/// `linear_nearest_level` filters in the nearest mip level, `trilinear` between two.
enum class Filtering { nearest, linear, linear_nearest_level, trilinear };
enum class Wrapping { clamp, repeat, mirror };

class Texture {
  public:
    Texture() = default;
    /// Throws ContextError when the size is beyond the driver's limit.
    Texture(Format format, int width, int height, int levels = 1, TextureKind kind = TextureKind::flat);
    /// `layers` textures of one level in one array. Throws ContextError beyond the driver's limits.
    static Texture layered(Format format, int width, int height, int layers);

    /// Pixels of one level (and cube face or layer), row 0 first, tightly packed.
    void upload(std::span<const std::byte> pixels, int level = 0, int face = 0);
    /// Bytes of one level of an 8-bit texture, 3 (opaque) or 4 channels.
    void upload_u8(std::span<const std::byte> pixels, int channels, int level);
    /// Pixels of a rectangle of level 0, row 0 first.
    void upload_area(int x, int y, int width, int height, std::span<const std::byte> pixels) const;
    void sampling(Filtering filtering, Wrapping u = Wrapping::clamp, Wrapping v = Wrapping::clamp,
                  float anisotropy = 1) const;
    /// Lets shaders see these levels alone, the first as level 0: while another level is drawn to.
    void show_levels(int first, int last) const;
    void bind(unsigned unit) const;

    uint32_t id() const { return object_.id(); }
    /// As Object::serial().
    uint64_t serial() const { return object_.serial(); }
    Format format() const { return format_; }
    int width() const { return width_; }
    int height() const { return height_; }
    int layers() const { return layers_; }
    explicit operator bool() const { return bool(object_); }

  private:
    Object object_;
    Format format_ = Format::rgba8;
    TextureKind kind_ = TextureKind::flat;
    int width_ = 0, height_ = 0, layers_ = 1;
};

/// Where a pass draws to. Keeps no texture alive.
class Framebuffer {
  public:
    Framebuffer() = default;
    /// Throws ContextError when the driver cannot draw to this set of textures.
    explicit Framebuffer(std::span<const Texture* const> colors, const Texture* depth = nullptr);
    Framebuffer(std::initializer_list<const Texture*> colors, const Texture* depth = nullptr)
        : Framebuffer(std::span(colors.begin(), colors.size()), depth) {}
    /// One layer of an array, or the same layer of several. Throws ContextError when the driver cannot draw
    /// to it.
    Framebuffer(const Texture& array, int layer) : Framebuffer({&array}, layer) {}
    Framebuffer(std::initializer_list<const Texture*> arrays, int layer);

    /// Made again unless it is of these textures, and of no others, already. Throws ContextError when the
    /// driver cannot draw to them.
    void attach(std::span<const Texture* const> colors, const Texture* depth = nullptr);
    void attach(std::initializer_list<const Texture*> colors, const Texture* depth = nullptr) {
        attach(std::span(colors.begin(), colors.size()), depth);
    }

    /// One mip level, with the viewport on it. Throws ContextError when the driver cannot draw to it.
    static Framebuffer of_level(const Texture& texture, int level);

    /// Binds it for drawing with the viewport on all of it.
    void bind() const;
    /// Clears are of the whole framebuffer, whatever the draw before limited itself to.
    void clear_color(unsigned index, const float (&rgba)[4]) const;
    /// For an integer attachment.
    void clear_integer(unsigned index, unsigned value) const;
    void clear_depth(float depth) const;

    /// Reads a rectangle of color attachment `index`, rows as they lie in the texture. `pixels` holds
    /// width * height * pixel_bytes(format).
    void read(unsigned index, Format format, int x, int y, int width, int height,
              std::span<std::byte> pixels) const;
    /// The same into the buffer that is bound to GL_PIXEL_PACK_BUFFER, which is large enough: for Readback.
    void read_to_bound_buffer(unsigned index, Format format, int x, int y, int width, int height) const;

    int width() const { return width_; }
    int height() const { return height_; }
    explicit operator bool() const { return bool(object_); }

  private:
    void require_complete() const;
    void read_to(unsigned index, Format format, int x, int y, int width, int height, void* to) const;

    Object object_;
    std::vector<uint64_t> attached_;  ///< serials of what attach() was called with, 0 for no depth
    int width_ = 0, height_ = 0;
};

/// Number of levels down to 1x1.
int full_levels(int width, int height);

/// Copies the first `layers` layers of an array to another of the same format and size.
void copy_layers(const Texture& from, const Texture& to, int layers);

/// Copies a whole texture to another of the same format and size.
void copy(const Texture& from, const Texture& to);

}  // namespace easypbr::gl
