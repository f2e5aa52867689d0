// Large arrays that are read for as long as their data live, in no order.
#pragma once

#include <cstddef>
#include <vector>

#include "easypbr/core/uninitialized_allocator.h"

namespace easypbr {

/// Memory for so many bytes, in large pages where the system has them: far fewer addresses of pages are
/// looked up by reads here and there. Aligned to 4096 bytes at least. Throws std::bad_alloc.
void* take_large(size_t bytes);
/// Frees what take_large() gave for as many bytes.
void give_large(void* memory, size_t bytes) noexcept;

/// Elements that are given no value are undefined.
template <class T>
using LargeVector = std::vector<T, UninitializedAllocator<T, take_large, give_large>>;

}  // namespace easypbr
