#include "easypbr/gl/object.h"

#include <epoxy/gl.h>

#include <atomic>

#include "easypbr/gl/context.h"

namespace easypbr::gl {
namespace {

void delete_name(ObjectKind kind, uintptr_t handle) {
    const GLuint id = GLuint(handle);
    switch (kind) {
        case ObjectKind::buffer:
            glDeleteBuffers(1, &id);
            break;
        case ObjectKind::texture:
            glDeleteTextures(1, &id);
            break;
        case ObjectKind::framebuffer:
            glDeleteFramebuffers(1, &id);
            break;
        case ObjectKind::vertex_array:
            glDeleteVertexArrays(1, &id);
            break;
        case ObjectKind::program:
            glDeleteProgram(id);
            break;
        case ObjectKind::query:
            glDeleteQueries(1, &id);
            break;
        case ObjectKind::fence:
            glDeleteSync(reinterpret_cast<GLsync>(handle));
            break;
    }
}

uintptr_t create_name(ObjectKind kind, GLenum target) {
    GLuint id = 0;
    switch (kind) {
        case ObjectKind::buffer:
            glCreateBuffers(1, &id);
            break;
        case ObjectKind::texture:
            glCreateTextures(target, 1, &id);
            break;
        case ObjectKind::framebuffer:
            glCreateFramebuffers(1, &id);
            break;
        case ObjectKind::vertex_array:
            glCreateVertexArrays(1, &id);
            break;
        case ObjectKind::program:
            id = glCreateProgram();
            break;
        case ObjectKind::query:
            glCreateQueries(target, 1, &id);
            break;
        case ObjectKind::fence:
            return reinterpret_cast<uintptr_t>(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    }
    return id;
}

}  // namespace

void DeletionQueue::push(ObjectKind kind, uintptr_t id) {
    std::lock_guard lock(mutex_);
    if (!closed_) waiting_.emplace_back(kind, id);
}

void DeletionQueue::flush() {
    std::vector<std::pair<ObjectKind, uintptr_t>> taken;
    {
        std::lock_guard lock(mutex_);
        taken.swap(waiting_);
    }
    for (const auto& [kind, id] : taken) delete_name(kind, id);
}

void DeletionQueue::close() {
    std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
}

Object::Object(ObjectKind kind, uint32_t target)
    : queue_(Context::with_driver().deletions()), id_(create_name(kind, target)), kind_(kind) {
    static std::atomic<uint64_t> last{0};
    serial_ = ++last;
}

void Object::reset() {
    if (!id_) return;
    const Context* current = Context::current_or_null();
    if (current && current->deletions() == queue_)
        delete_name(kind_, id_);
    else
        queue_->push(kind_, id_);
    id_ = 0;
    serial_ = 0;
    queue_.reset();
}

}  // namespace easypbr::gl
