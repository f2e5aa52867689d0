#include "easypbr/core/memory_pool.h"

#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <mutex>

namespace easypbr {
namespace {

constexpr auto alignment = std::align_val_t(64);
#ifdef __SANITIZE_ADDRESS__
constexpr size_t most_kept = 0;  // The sanitizer knows of memory that is freed.
#else
constexpr size_t most_kept = PooledMemory::most_kept;
#endif
constexpr size_t most_blocks = 256;

/// In steps of a quarter of a power of two, so that arrays of nearly the same size share memory. Pages that
/// nobody touches take none.
size_t block_size(size_t bytes) {
    const size_t step = std::bit_floor(bytes) / 4;
    return (bytes + step - 1) / step * step;
}

/// Null: there is none. Pages go back to the system when it is freed, which a heap with holes would keep.
void* allocate(size_t bytes) {
#ifdef __SANITIZE_ADDRESS__
    return ::operator new(bytes, alignment, std::nothrow);
#else
    void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return memory == MAP_FAILED ? nullptr : memory;
#endif
}

void deallocate(void* memory, [[maybe_unused]] size_t bytes) {
#ifdef __SANITIZE_ADDRESS__
    ::operator delete(memory, alignment);
#else
    ::munmap(memory, bytes);
#endif
}

class Pool {
  public:
    Pool() { kept_.reserve(most_blocks + 1); }

    /// Null: the system has none either.
    void* take(size_t bytes) {
        const std::lock_guard lock(mutex_);
        Block block{nullptr, bytes};
        if (const auto found = find(bytes); found != kept_.end()) {
            block = *found;
            if (block.bytes != bytes) larger_.push_back(block);
            kept_bytes_ -= block.bytes;
            kept_.erase(found);
        } else {
            const size_t given = given_ + bytes;
            shrink(most_given_ > given ? most_given_ - given : 0);
            block.memory = allocate(bytes);
            if (!block.memory) {
                shrink(0);
                block.memory = allocate(bytes);
            }
            if (!block.memory) return nullptr;
        }
        given_ += block.bytes;
        most_given_ = std::max(most_given_, given_);
        return block.memory;
    }

    void give(void* memory, size_t bytes) noexcept {
        const std::lock_guard lock(mutex_);
        Block block{memory, bytes};
        const auto larger = std::ranges::find(larger_, memory, &Block::memory);
        if (larger != larger_.end()) {
            block = *larger;
            larger_.erase(larger);
        }
        given_ -= block.bytes;
        kept_.push_back(block);
        kept_bytes_ += block.bytes;
        shrink(most_kept);
    }

    PooledMemory now() {
        const std::lock_guard lock(mutex_);
        return {kept_bytes_, given_};
    }

  private:
    struct Block {
        void* memory;
        size_t bytes;
    };

    /// The smallest block that is large enough, up to twice as large: the passes of a frame ask for other
    /// sizes one after the other. Of those of one size the last that came back, the likeliest to be in a
    /// cache.
    std::vector<Block>::iterator find(size_t bytes) {
        auto found = kept_.end();
        for (auto block = kept_.begin(); block != kept_.end(); ++block)
            if (block->bytes >= bytes && block->bytes / 2 <= bytes &&
                (found == kept_.end() || block->bytes <= found->bytes))
                found = block;
        return found;
    }

    /// Frees the oldest blocks until no more bytes are kept.
    void shrink(size_t to) {
        auto block = kept_.begin();
        for (; kept_bytes_ > to || size_t(kept_.end() - block) > most_blocks; ++block) {
            kept_bytes_ -= block->bytes;
            deallocate(block->memory, block->bytes);
        }
        kept_.erase(kept_.begin(), block);
    }

    std::mutex mutex_;
    std::vector<Block> kept_;    ///< in the order in which they came back
    std::vector<Block> larger_;  ///< given away for less
    size_t kept_bytes_ = 0, given_ = 0, most_given_ = 0;
};

/// Never destroyed: arrays that outlive static objects give their memory back.
Pool& pool() {
    static Pool& only = *new Pool;
    return only;
}

}  // namespace

void* take_pooled(size_t bytes) {
    if (bytes < PooledMemory::smallest) return ::operator new(bytes, alignment);
    if (bytes > std::numeric_limits<size_t>::max() / 2) throw std::bad_alloc();
    void* memory = pool().take(block_size(bytes));
    if (!memory) throw std::bad_alloc();
    return memory;
}

void give_pooled(void* memory, size_t bytes) noexcept {
    if (bytes < PooledMemory::smallest)
        ::operator delete(memory, alignment);
    else
        pool().give(memory, block_size(bytes));
}

PooledMemory pooled_memory() {
    return pool().now();
}

}  // namespace easypbr
