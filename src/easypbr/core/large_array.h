// Large arrays that are read for as long as their data live, in no order.
#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <vector>

namespace easypbr {

/// Memory for so many bytes, in large pages where the system has them: far fewer addresses of pages are
/// looked up by reads here and there. Aligned to 4096 bytes at least. Throws std::bad_alloc.
void* take_large(size_t bytes);
/// Frees what take_large() gave for as many bytes.
void give_large(void* memory, size_t bytes) noexcept;

/// An allocator of std::vector by take_large(). Elements that are given no value are undefined.
template <class T>
struct LargeAllocator {
    using value_type = T;
    LargeAllocator() = default;
    template <class U>
    LargeAllocator(const LargeAllocator<U>& /*other*/) noexcept {}  // NOLINT(google-explicit-constructor)

    T* allocate(size_t count) {
        if (count > std::numeric_limits<size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(take_large(count * sizeof(T)));
    }
    void deallocate(T* memory, size_t count) noexcept { give_large(memory, count * sizeof(T)); }
    template <class U>
    void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class Value>
    void construct(U* at, Value&& value) {
        ::new (static_cast<void*>(at)) U(static_cast<Value&&>(value));
    }
    template <class U>
    bool operator==(const LargeAllocator<U>& /*other*/) const noexcept {
        return true;
    }
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace easypbr
