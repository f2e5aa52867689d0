// The disk cache: blobs by key, kept between runs, safe to delete at any time. Processes may share it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr {

/// Folder of the cache: $EASYPBR_CACHE_DIR, else $XDG_CACHE_HOME/easypbr, else ~/.cache/easypbr; empty where
/// the user has no home. Of the last two one that belongs to another user is not used, nor are other users'
/// files in it; root's are. The first one may be shared: who can write there can change what is drawn.
std::filesystem::path cache_folder();

/// Why nothing can be kept there; empty: it can.
std::string cache_problem();

/// Bytes that the blobs may take: $EASYPBR_CACHE_LIMIT in GB (10^9 bytes), 0: nothing is kept. 1 GB where it
/// is not set. Throws ArgumentError where it is no number from 0 on.
uint64_t cache_limit();

/// The blob stored under `key`, or nothing when there is none, it is damaged, it was stored under another key
/// or the cache cannot be read. It counts as used now. Throws as cache_limit().
std::optional<std::vector<std::byte>> cache_load(std::string_view key);

/// Stores a blob, then drops those that were not used for the longest until all are within cache_limit(). A
/// key is a word and content_hash() of what the blob is made from: "env6-99aa...". A cache that cannot be
/// written is not an error.
void cache_store(std::string_view key, std::span<const std::byte> blob) noexcept;

struct CacheUse {
    size_t entries = 0;
    uint64_t bytes = 0;
};

/// What the cache holds. Files that it did not write do not count.
CacheUse cache_use();

/// Drops the blobs that were not used for the longest until the rest takes at most `limit` bytes, and what
/// killed processes left; no other files. Returns what is left, more than `limit` where files cannot be
/// removed.
CacheUse trim_cache(uint64_t limit);

}  // namespace easypbr
