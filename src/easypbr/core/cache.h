// The disk cache: blobs by key, kept between runs, safe to delete at any time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace easypbr {

/// Folder of the cache: $EASYPBR_CACHE_DIR, else $XDG_CACHE_HOME/easypbr, else ~/.cache/easypbr.
std::filesystem::path cache_folder();

/// The blob stored under `key`, or nothing when there is none, it is damaged or the cache cannot be read.
std::optional<std::vector<std::byte>> cache_load(std::string_view key);

/// Stores a blob; a cache that cannot be written is not an error.
void cache_store(std::string_view key, std::span<const std::byte> blob) noexcept;

}  // namespace easypbr
