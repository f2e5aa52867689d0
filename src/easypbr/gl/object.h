// Ownership of OpenGL names: move-only handles that are deleted in their own context.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace easypbr::gl {

/// `fence` is a point in the stream of commands; its handle is a pointer.
enum class ObjectKind { buffer, texture, framebuffer, vertex_array, program, query, fence };

/// Names of objects whose handles died elsewhere; emptied whenever the context is current.
class DeletionQueue {
  public:
    void push(ObjectKind kind, uintptr_t id);
    /// Deletes all waiting names; the context must be current.
    void flush();
    /// From now on names are forgotten: the context is gone.
    void close();

  private:
    std::mutex mutex_;
    bool closed_ = false;
    std::vector<std::pair<ObjectKind, uintptr_t>> waiting_;
};

/// Owns one OpenGL name. Empty by default and after a move. May be destroyed on any thread.
class Object {
  public:
    Object() = default;
    /// Creates a name in the current context.
    explicit Object(ObjectKind kind, uint32_t target = 0);
    ~Object() { reset(); }
    Object(Object&& other) noexcept
        : queue_(std::move(other.queue_)),
          id_(std::exchange(other.id_, 0)),
          serial_(std::exchange(other.serial_, 0)),
          kind_(other.kind_) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(queue_, other.queue_);
        std::swap(id_, other.id_);
        std::swap(serial_, other.serial_);
        std::swap(kind_, other.kind_);
        return *this;
    }

    uint32_t id() const { return uint32_t(id_); }
    /// Tells it from all objects before and after it, where drivers give the names of deleted objects again.
    /// 0 when it is empty.
    uint64_t serial() const { return serial_; }
    /// A fence's.
    void* pointer() const { return reinterpret_cast<void*>(id_); }
    explicit operator bool() const { return id_ != 0; }
    void reset();

  private:
    std::shared_ptr<DeletionQueue> queue_;
    uintptr_t id_ = 0;
    uint64_t serial_ = 0;
    ObjectKind kind_ = ObjectKind::buffer;
};

}  // namespace easypbr::gl
