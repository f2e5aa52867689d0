// Memory of large arrays that come and go with frames: it is kept for the next one.
#pragma once

#include <cstddef>
#include <vector>

#include "easypbr/core/uninitialized_allocator.h"

namespace easypbr {

/// Memory for so many bytes, by the pool where it holds a block of up to twice that size. The system hands
/// out pages one by one and clears each, which takes longer than most passes take to fill them. Throws
/// std::bad_alloc. Any thread.
void* take_pooled(size_t bytes);
/// Takes back what take_pooled() gave for as many bytes.
void give_pooled(void* memory, size_t bytes) noexcept;

/// What the pool holds and has given away, in bytes. Both together are never more than was given away at once
/// at some time: a request that no block serves frees others.
struct PooledMemory {
    /// Beyond it, what comes back is freed.
    static constexpr size_t most_kept = size_t(256) << 20;
    /// Smaller arrays are allocated as usual.
    static constexpr size_t smallest = size_t(256) << 10;

    size_t kept = 0, given = 0;
};
PooledMemory pooled_memory();

/// Elements that are given no value are undefined.
template <class T>
using PooledVector = std::vector<T, UninitializedAllocator<T, take_pooled, give_pooled>>;

}  // namespace easypbr
