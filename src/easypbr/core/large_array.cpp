#include "easypbr/core/large_array.h"

#include <sys/mman.h>

namespace easypbr {
namespace {

constexpr size_t page = 4096, large_page = size_t(2) << 20;

std::align_val_t alignment_of(size_t bytes) {
    return std::align_val_t(bytes < large_page ? page : large_page);
}

}  // namespace

void* take_large(size_t bytes) {
    void* const memory = ::operator new(bytes, alignment_of(bytes));
    // Whole large pages alone: the rest of the last one may be somebody else's. Where there are none, it is
    // as it was.
    if (const size_t whole = bytes / large_page * large_page; whole > 0)
        ::madvise(memory, whole, MADV_HUGEPAGE);
    return memory;
}

void give_large(void* memory, size_t bytes) noexcept {
    ::operator delete(memory, alignment_of(bytes));
}

}  // namespace easypbr
