#include "easypbr/core/cache.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/hash.h"

namespace easypbr {
namespace {

constexpr size_t hash_digits = 32;

fs::path path_of(std::string_view key) {
    return cache_folder() / std::string(key);
}

}  // namespace

fs::path cache_folder() {
    if (const char* folder = std::getenv("EASYPBR_CACHE_DIR"); folder && *folder) return folder;
    if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder)
        return fs::path(folder) / "easypbr";
    const char* home = std::getenv("HOME");
    return fs::path(home && *home ? home : "/tmp") / ".cache" / "easypbr";
}

std::optional<std::vector<std::byte>> cache_load(std::string_view key) {
    try {
        const FileBytes file(path_of(key));
        if (file.size() < hash_digits) return std::nullopt;
        const auto blob = file.bytes().subspan(hash_digits);
        if (content_hash(blob) != file.text().substr(0, hash_digits)) return std::nullopt;
        return std::vector<std::byte>(blob.begin(), blob.end());
    } catch (const Error&) {
        return std::nullopt;
    }
}

void cache_store(std::string_view key, std::span<const std::byte> blob) noexcept {
    try {
        std::error_code ignored;
        fs::create_directories(cache_folder(), ignored);
        const std::string hash = content_hash(blob);
        std::vector<std::byte> bytes(hash_digits + blob.size());
        std::copy_n(reinterpret_cast<const std::byte*>(hash.data()), hash_digits, bytes.begin());
        std::copy(blob.begin(), blob.end(), bytes.begin() + hash_digits);
        write_file(path_of(key), bytes);
    } catch (...) {
        // A full disk or a read-only home only means that the work is done again next time.
        return;
    }
}

}  // namespace easypbr
