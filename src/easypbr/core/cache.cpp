#include "easypbr/core/cache.h"

#include <dirent.h>
#include <fast_float/fast_float.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/file_set.h"
#include "easypbr/core/hash.h"
#include "easypbr/core/open_file.h"
#include "easypbr/core/variable.h"

namespace easypbr {
namespace {

constexpr size_t hash_digits = 32;
constexpr double default_limit_gb = 1;
/// A temporary file of this age is not being written any more.
constexpr auto abandoned = std::chrono::hours(1);

const char* chosen_folder() {
    const char* folder = std::getenv("EASYPBR_CACHE_DIR");
    return folder && *folder ? folder : nullptr;
}

/// Empty where the user has none.
fs::path home_folder() {
    if (const char* home = std::getenv("HOME"); home && *home) return home;
    passwd entry{}, *found = nullptr;
    std::vector<char> text(16384);
    ::getpwuid_r(::geteuid(), &entry, text.data(), text.size(), &found);
    return found && found->pw_dir ? found->pw_dir : "";
}

/// Another user's files may be traps, unless the folder was chosen: users may share it.
bool is_trusted(uid_t owner) {
    return owner == ::geteuid() || owner == 0 || chosen_folder();
}

/// No descriptor where there is no folder, or another user's.
Descriptor open_folder() {
    const fs::path path = cache_folder();
    if (path.empty()) return Descriptor();
    Descriptor folder{open_file(path.c_str(), O_RDONLY | O_DIRECTORY)};
    struct stat info {};
    const bool is_good = ::fstat(folder.get(), &info) == 0 && is_trusted(info.st_uid);
    return is_good ? std::move(folder) : Descriptor();
}

void make_folder() {
    const fs::path path = cache_folder();
    if (path.empty()) return;
    std::error_code ignored;
    // The user's own is nobody else's matter.
    fs::create_directories(chosen_folder() ? path : path.parent_path(), ignored);
    ::mkdir(path.c_str(), 0700);
}

/// Throws FileError for what is no entry that can be read: a link, a pipe, another user's file.
InputFile open_entry(const Descriptor& folder, const std::string& name) {
    InputFile file(Descriptor(open_file_in(folder.get(), name.c_str(), O_RDONLY | O_NONBLOCK)), name);
    struct stat info {};
    if (::fstat(file.descriptor(), &info) != 0 || !is_trusted(info.st_uid))
        throw FileError(fmt::format("cannot read {}: it is another user's", name));
    return file;
}

/// A link in the place of the entry is replaced.
void write_entry(const Descriptor& folder, const std::string& name, std::span<const std::byte> bytes) {
    const std::string beside = temporary_name();
    const Descriptor file{open_file_in(folder.get(), beside.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666)};
    if (file.get() < 0) return;
    try {
        write_all(file.get(), bytes, name);
    } catch (...) {
        ::unlinkat(folder.get(), beside.c_str(), 0);
        throw;
    }
    if (::renameat(folder.get(), beside.c_str(), folder.get(), name.c_str()) != 0)
        ::unlinkat(folder.get(), beside.c_str(), 0);
}

std::string text_hash(std::string_view text) {
    return content_hash(std::as_bytes(std::span(text)));
}

/// What an entry begins with. It names the key too: one entry under another's name is damaged.
std::string entry_hash(std::string_view key, std::span<const std::byte> blob) {
    return text_hash(text_hash(key) + content_hash(blob));
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
    std::string name;
    std::chrono::nanoseconds used;  ///< since 1970
    uint64_t bytes = 0;
};

/// Calls visit(entry) for the regular files of the folder. Other processes may remove them meanwhile.
template <class Visit>
void for_each_file(const Descriptor& folder, Visit&& visit) {
    // Closed by closedir().
    const int read = open_file_in(folder.get(), ".", O_RDONLY | O_DIRECTORY);
    const std::unique_ptr<DIR, int (*)(DIR*)> list(read < 0 ? nullptr : ::fdopendir(read), ::closedir);
    if (!list) return;
    while (const dirent* found = ::readdir(list.get())) {
        struct stat info {};
        if (::fstatat(folder.get(), found->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0) continue;
        if (!S_ISREG(info.st_mode)) continue;
        const auto used =
            std::chrono::seconds(info.st_mtim.tv_sec) + std::chrono::nanoseconds(info.st_mtim.tv_nsec);
        visit(Entry{found->d_name, used, uint64_t(info.st_size)});
    }
}

/// Blobs begin with their hash.
bool is_blob(const Descriptor& folder, const std::string& name) {
    try {
        std::string head(hash_digits, ' ');
        open_entry(folder, name).read(0, std::as_writable_bytes(std::span(head)));
        return is_hash(head);
    } catch (const FileError&) {
        return false;
    }
}

std::vector<Entry> blobs(const Descriptor& folder) {
    std::vector<Entry> found;
    for_each_file(folder, [&](const Entry& entry) {
        if (is_key(entry.name) && is_blob(folder, entry.name)) found.push_back(entry);
    });
    return found;
}

void remove_abandoned(const Descriptor& folder) {
    const auto before = std::chrono::system_clock::now().time_since_epoch() - abandoned;
    for_each_file(folder, [&](const Entry& entry) {
        if (is_temporary_name(entry.name) && entry.used < before)
            ::unlinkat(folder.get(), entry.name.c_str(), 0);
    });
}

CacheUse sum_of(const std::vector<Entry>& entries) {
    CacheUse use{entries.size(), 0};
    for (const Entry& entry : entries) use.bytes += entry.bytes;
    return use;
}

}  // namespace

fs::path cache_folder() {
    if (const char* folder = chosen_folder()) return folder;
    if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder)
        return fs::path(folder) / "easypbr";
    const fs::path home = home_folder();
    return home.empty() ? home : home / ".cache" / "easypbr";
}

std::string cache_problem() {
    fs::path folder = cache_folder();
    if (folder.empty()) return "there is no home folder";
    struct stat info {};
    if (::stat(folder.c_str(), &info) == 0 && !is_trusted(info.st_uid)) return "it belongs to another user";
    // It is made when it is first needed, so its nearest ancestor that exists must be writable.
    while (::access(folder.c_str(), F_OK) != 0 && folder.has_relative_path()) folder = folder.parent_path();
    return ::access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0 ? "" : "not writable";
}

uint64_t cache_limit() {
    double gb = default_limit_gb;
    if (const std::optional<std::string> given = variable("EASYPBR_CACHE_LIMIT")) {
        const char* end = given->data() + given->size();
        const auto [stop, error] = fast_float::from_chars(given->data(), end, gb);
        if (error != std::errc() || stop != end || !(gb >= 0))
            throw ArgumentError(
                fmt::format("EASYPBR_CACHE_LIMIT: expected a number of GB, 0 or more, got '{}'", *given));
    }
    return uint64_t(std::min(gb, 1e9) * 1e9);
}

std::optional<std::vector<std::byte>> cache_load(std::string_view key) {
    cache_limit();  // A wrong one is told before the work whose result is to be kept.
    try {
        const Descriptor folder = open_folder();
        const std::string name(key);
        const FileBytes file(open_entry(folder, name));
        if (file.size() < hash_digits) return std::nullopt;
        const auto blob = file.bytes().subspan(hash_digits);
        if (entry_hash(key, blob) != file.text().substr(0, hash_digits)) return std::nullopt;
        std::vector<std::byte> copy(blob.begin(), blob.end());
        file.check();
        ::utimensat(folder.get(), name.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
        return copy;
    } catch (const Error&) {
        return std::nullopt;
    }
}

void cache_store(std::string_view key, std::span<const std::byte> blob) noexcept {
    try {
        const uint64_t limit = cache_limit();
        if (hash_digits + blob.size() > limit) return;
        make_folder();
        const Descriptor folder = open_folder();
        if (folder.get() < 0) return;
        const std::string hash = entry_hash(key, blob);
        std::vector<std::byte> bytes(hash_digits + blob.size());
        std::copy_n(reinterpret_cast<const std::byte*>(hash.data()), hash_digits, bytes.begin());
        std::copy(blob.begin(), blob.end(), bytes.begin() + hash_digits);
        write_entry(folder, std::string(key), bytes);
        trim_cache(limit);
    } catch (...) {
        // A full disk or a read-only home only means that the work is done again next time.
        return;
    }
}

CacheUse cache_use() {
    return sum_of(blobs(open_folder()));
}

CacheUse trim_cache(uint64_t limit) {
    const Descriptor folder = open_folder();
    remove_abandoned(folder);
    std::vector<Entry> entries = blobs(folder);
    std::ranges::sort(entries, {}, &Entry::used);
    CacheUse use = sum_of(entries);
    for (const Entry& entry : entries) {
        if (use.bytes <= limit) break;
        // Who reads it at the moment keeps its bytes; what another process has removed is gone as well.
        if (::unlinkat(folder.get(), entry.name.c_str(), 0) != 0 && errno != ENOENT) continue;
        use.bytes -= entry.bytes;
        --use.entries;
    }
    return use;
}

}  // namespace easypbr
