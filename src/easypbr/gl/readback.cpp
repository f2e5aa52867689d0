#include "easypbr/gl/readback.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstring>

#include "easypbr/core/error.h"
#include "easypbr/gl/context.h"

namespace easypbr::gl {
namespace {

/// In nanoseconds; a wait that is over is begun again.
constexpr GLuint64 patience = 1'000'000'000;

GLsync sync_of(const Object& fence) {
    return static_cast<GLsync>(fence.pointer());
}

/// A buffer that the driver keeps where the processor reads quickly.
Object make_buffer(size_t size) {
    Object buffer(ObjectKind::buffer);
    forget_errors();
    glNamedBufferStorage(buffer.id(), GLsizeiptr(size), nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw ContextError(fmt::format("the device has no memory for reading {} bytes of pixels back", size));
    return buffer;
}

}  // namespace

void Readback::begin(const Framebuffer& from, unsigned index, Format format, int x, int y, int width,
                     int height) {
    fence_.reset();
    const size_t size = size_t(width) * size_t(height) * pixel_bytes(format);
    if (!buffer_ || size != size_) buffer_ = make_buffer(size);
    size_ = size;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.id());
    from.read_to_bound_buffer(index, format, x, y, width, height);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    fence_ = Object(ObjectKind::fence);
    glFlush();  // Nothing else may come that makes the driver begin.
}

bool Readback::is_done() const {
    return fence_ && glClientWaitSync(sync_of(fence_), 0, 0) != GL_TIMEOUT_EXPIRED;
}

void Readback::finish(std::span<std::byte> pixels) {
    if (!fence_ || pixels.size() != size_)
        throw ArgumentError(
            fmt::format("reading back: expected {} bytes, got {}", fence_ ? size_ : 0, pixels.size()));
    while (glClientWaitSync(sync_of(fence_), GL_SYNC_FLUSH_COMMANDS_BIT, patience) == GL_TIMEOUT_EXPIRED) {
    }
    fence_.reset();
    const void* from = glMapNamedBufferRange(buffer_.id(), 0, GLsizeiptr(size_), GL_MAP_READ_BIT);
    if (from) std::memcpy(pixels.data(), from, size_);
    const bool kept = from && glUnmapNamedBuffer(buffer_.id());
    if (!kept) throw ContextError("the driver gave a picture that was read back away");
}

}  // namespace easypbr::gl
