// Content hashes (XXH3, 128 bits) as keys of caches and in saved settings; not for security.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace easypbr {

/// 32 hexadecimal digits of the XXH3-128 hash of the bytes.
std::string content_hash(std::span<const std::byte> bytes);

/// A process-wide unique number that grows: the revision of an edit.
uint64_t next_revision();

}  // namespace easypbr
