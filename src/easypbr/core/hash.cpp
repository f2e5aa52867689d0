#include "easypbr/core/hash.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <atomic>

namespace easypbr {

std::string content_hash(std::span<const std::byte> bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

uint64_t next_revision() {
    static std::atomic<uint64_t> counter{0};
    return ++counter;
}

}  // namespace easypbr
