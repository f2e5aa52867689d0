#include "easypbr/core/cache.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/file_set.h"
#include "easypbr/core/folder.h"
#include "easypbr/core/hash.h"

namespace easypbr {
namespace {

constexpr size_t hash_digits = 32;
constexpr double default_limit_gb = 1;
/// A temporary file of this age is not being written any more.
constexpr auto abandoned = std::chrono::hours(1);

fs::path path_of(std::string_view key) {
    return cache_folder() / std::string(key);
}

bool is_hash(std::string_view text) {
    return text.size() == hash_digits && text.find_first_not_of("0123456789abcdef") == text.npos;
}

/// Whether a name is a key: the folder is the user's choice and may hold other files.
bool is_key(std::string_view name) {
    const size_t dash = name.rfind('-');
    return dash != name.npos && dash > 0 && name[0] != '.' && is_hash(name.substr(dash + 1));
}

struct Entry {
    fs::path path;
    fs::file_time_type used;
    uint64_t bytes = 0;
};

/// Calls visit(name, entry) for the regular files of the cache's folder. Other processes may remove them
/// meanwhile.
template <class Visit>
void for_each_file(Visit&& visit) {
    std::error_code error;
    for (fs::directory_iterator at(cache_folder(), error), end; !error && at != end; at.increment(error)) {
        std::error_code gone;
        if (at->symlink_status(gone).type() != fs::file_type::regular || gone) continue;
        Entry entry{at->path(), at->last_write_time(gone), 0};
        if (!gone) entry.bytes = at->file_size(gone);
        if (!gone) visit(at->path().filename().string(), entry);
    }
}

/// Blobs begin with their hash.
bool is_blob(const fs::path& path) {
    try {
        std::string head(hash_digits, ' ');
        InputFile(path).read(0, std::as_writable_bytes(std::span(head)));
        return is_hash(head);
    } catch (const FileError&) {
        return false;
    }
}

std::vector<Entry> blobs() {
    std::vector<Entry> found;
    for_each_file([&](const std::string& name, const Entry& entry) {
        if (is_key(name) && is_blob(entry.path)) found.push_back(entry);
    });
    return found;
}

void remove_abandoned() {
    const auto before = fs::file_time_type::clock::now() - abandoned;
    for_each_file([&](const std::string& name, const Entry& entry) {
        std::error_code ignored;
        if (is_temporary_name(name) && entry.used < before) fs::remove(entry.path, ignored);
    });
}

CacheUse sum_of(const std::vector<Entry>& entries) {
    CacheUse use{entries.size(), 0};
    for (const Entry& entry : entries) use.bytes += entry.bytes;
    return use;
}

}  // namespace

fs::path cache_folder() {
    if (const char* folder = std::getenv("EASYPBR_CACHE_DIR"); folder && *folder) return folder;
    if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder)
        return fs::path(folder) / "easypbr";
    const char* home = std::getenv("HOME");
    return fs::path(home && *home ? home : "/tmp") / ".cache" / "easypbr";
}

uint64_t cache_limit() {
    const char* given = std::getenv("EASYPBR_CACHE_LIMIT");
    const std::string_view text = given ? given : "";
    double gb = default_limit_gb;
    const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), gb);
    if (error != std::errc() || end != text.data() + text.size() || !(gb >= 0)) gb = default_limit_gb;
    return uint64_t(std::min(gb, 1e9) * 1e9);
}

std::optional<std::vector<std::byte>> cache_load(std::string_view key) {
    const FolderScope anywhere(nullptr);
    try {
        const FileBytes file(path_of(key));
        if (file.size() < hash_digits) return std::nullopt;
        const auto blob = file.bytes().subspan(hash_digits);
        if (content_hash(blob) != file.text().substr(0, hash_digits)) return std::nullopt;
        std::error_code ignored;
        fs::last_write_time(path_of(key), fs::file_time_type::clock::now(), ignored);
        return std::vector<std::byte>(blob.begin(), blob.end());
    } catch (const Error&) {
        return std::nullopt;
    }
}

void cache_store(std::string_view key, std::span<const std::byte> blob) noexcept {
    try {
        const uint64_t limit = cache_limit();
        if (hash_digits + blob.size() > limit) return;
        std::error_code ignored;
        fs::create_directories(cache_folder(), ignored);
        const std::string hash = content_hash(blob);
        std::vector<std::byte> bytes(hash_digits + blob.size());
        std::copy_n(reinterpret_cast<const std::byte*>(hash.data()), hash_digits, bytes.begin());
        std::copy(blob.begin(), blob.end(), bytes.begin() + hash_digits);
        write_file(path_of(key), bytes);
        trim_cache(limit);
    } catch (...) {
        // A full disk or a read-only home only means that the work is done again next time.
        return;
    }
}

CacheUse cache_use() {
    return sum_of(blobs());
}

CacheUse trim_cache(uint64_t limit) {
    remove_abandoned();
    std::vector<Entry> entries = blobs();
    std::ranges::sort(entries, {}, &Entry::used);
    CacheUse use = sum_of(entries);
    for (const Entry& entry : entries) {
        if (use.bytes <= limit) break;
        std::error_code failed;
        // Who reads it at the moment keeps its bytes; what another process has removed is gone as well.
        fs::remove(entry.path, failed);
        if (failed) continue;
        use.bytes -= entry.bytes;
        --use.entries;
    }
    return use;
}

}  // namespace easypbr
