// An allocator for std::vector that leaves new elements uninitialized.
#pragma once

#include <cstddef>
#include <limits>
#include <new>

namespace easypbr {

/// Allocates by take(bytes) and frees by give(memory, bytes). Elements that are given no value are
/// uninitialized.
template <class T, void* (*take)(size_t), void (*give)(void*, size_t) noexcept>
struct UninitializedAllocator {
    using value_type = T;
    template <class U>
    struct rebind {
        using other = UninitializedAllocator<U, take, give>;
    };

    UninitializedAllocator() = default;
    template <class U>
    // NOLINTNEXTLINE(google-explicit-constructor)
    UninitializedAllocator(const UninitializedAllocator<U, take, give>& /*other*/) noexcept {}

    T* allocate(size_t count) {
        if (count > std::numeric_limits<size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(take(count * sizeof(T)));
    }
    void deallocate(T* memory, size_t count) noexcept { give(memory, count * sizeof(T)); }
    template <class U>
    void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class Value>
    void construct(U* at, Value&& value) {
        ::new (static_cast<void*>(at)) U(static_cast<Value&&>(value));
    }
    template <class U>
    bool operator==(const UninitializedAllocator<U, take, give>& /*other*/) const noexcept {
        return true;
    }
};

}  // namespace easypbr
