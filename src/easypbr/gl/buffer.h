// Buffers and vertex arrays.
#pragma once

#include <cstddef>
#include <span>

#include "easypbr/gl/object.h"

namespace easypbr::gl {

/// Immutable-size storage on the device.
class Buffer {
  public:
    Buffer() = default;
    /// Filled with the bytes. Throws ContextError when the memory cannot be had.
    explicit Buffer(std::span<const std::byte> bytes);
    /// Of a given size, for update().
    explicit Buffer(size_t size);

    void update(size_t offset, std::span<const std::byte> bytes);
    /// Waits for what writes it.
    void read(size_t offset, std::span<std::byte> bytes) const;
    void bind_uniform(unsigned slot) const;
    /// For shaders that read or write it as an array.
    void bind_storage(unsigned slot) const;

    uint32_t id() const { return object_.id(); }
    size_t size() const { return size_; }
    explicit operator bool() const { return bool(object_); }

  private:
    Object object_;
    size_t size_ = 0;
};

enum class AttributeType { f32, snorm16, unorm8 };

/// Vertex attributes and indices of one draw. Keeps no buffer alive.
class VertexArray {
  public:
    VertexArray() = default;
    /// A vertex array without attributes, for shaders that need none.
    static VertexArray make();

    /// From byte `offset` on, every `stride` bytes; with a divisor of 1 once per instance.
    void attribute(unsigned location, const Buffer& buffer, int components, AttributeType type, int stride,
                   int offset = 0, int divisor = 0);
    void indices(const Buffer& buffer);
    void bind() const;

    explicit operator bool() const { return bool(object_); }

  private:
    Object object_;
};

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

}  // namespace easypbr::gl
