#include "easypbr/gl/buffer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/gl/context.h"

namespace easypbr::gl {
namespace {

void allocate(GLuint id, size_t size, const void* data, GLbitfield flags) {
    forget_errors();
    glNamedBufferStorage(id, GLsizeiptr(std::max<size_t>(size, 4)), size ? data : nullptr, flags);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw ContextError(fmt::format("the device has no memory for a buffer of {} bytes", size));
}

}  // namespace

Buffer::Buffer(std::span<const std::byte> bytes) : object_(ObjectKind::buffer), size_(bytes.size()) {
    allocate(id(), size_, bytes.data(), 0);
}

Buffer::Buffer(size_t size) : object_(ObjectKind::buffer), size_(size) {
    allocate(id(), size_, nullptr, GL_DYNAMIC_STORAGE_BIT);
}

void Buffer::update(size_t offset, std::span<const std::byte> bytes) {
    glNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(bytes.size()), bytes.data());
}

void Buffer::read(size_t offset, std::span<std::byte> bytes) const {
    glGetNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(bytes.size()), bytes.data());
}

void Buffer::bind_uniform(unsigned slot) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, slot, id());
}

void Buffer::bind_storage(unsigned slot) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, slot, id());
}

VertexArray VertexArray::make() {
    VertexArray made;
    made.object_ = Object(ObjectKind::vertex_array);
    return made;
}

void VertexArray::attribute(unsigned location, const Buffer& buffer, int components, AttributeType type,
                            int stride, int offset, int divisor) {
    const GLenum gl_type = type == AttributeType::f32       ? GL_FLOAT
                           : type == AttributeType::snorm16 ? GL_SHORT
                                                            : GL_UNSIGNED_BYTE;
    glEnableVertexArrayAttrib(object_.id(), location);
    glVertexArrayVertexBuffer(object_.id(), location, buffer.id(), offset, stride);
    glVertexArrayAttribFormat(object_.id(), location, components, gl_type, type != AttributeType::f32, 0);
    glVertexArrayAttribBinding(object_.id(), location, location);
    glVertexArrayBindingDivisor(object_.id(), location, GLuint(divisor));
}

void VertexArray::indices(const Buffer& buffer) {
    glVertexArrayElementBuffer(object_.id(), buffer.id());
}

void VertexArray::bind() const {
    glBindVertexArray(object_.id());
}

}  // namespace easypbr::gl
