#include "easypbr/core/file_set.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/open_file.h"

namespace easypbr {
namespace {

constexpr std::string_view temporary_prefix = ".easypbr.", temporary_suffix = ".tmp";

[[noreturn]] void fail_write(const fs::path& path, int error) {
    throw FileError(fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
}

/// What is at a target; nothing where no file is there yet. A file that is renamed over a device or a pipe
/// would take its place.
std::optional<struct stat> status_of(const fs::path& target) {
    struct stat info {};
    if (::stat(target.c_str(), &info) != 0) {
        if (errno != ENOENT) fail_write(target, errno);
        return std::nullopt;
    }
    if (!S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
        throw FileError(fmt::format("cannot write {}: it is a device, a pipe or a socket", target.string()));
    return info;
}

void require_writable(const fs::path& target) {
    const auto old = status_of(target);
    if (target.filename().empty() || (old && S_ISDIR(old->st_mode))) fail_write(target, EISDIR);
    if (old && ::access(target.c_str(), W_OK) != 0) fail_write(target, errno);
}

struct NewFile {
    fs::path path;
    Descriptor file;
};

/// A new file gets the owner and the permissions of the one that it replaces. Where it may not have the
/// group, another group gets no more than everybody.
void take_over_access(int descriptor, const struct stat& old) {
    mode_t mode = old.st_mode & 0777;
    const bool has_group =
        ::fchown(descriptor, old.st_uid, old.st_gid) == 0 || ::fchown(descriptor, uid_t(-1), old.st_gid) == 0;
    if (!has_group) mode &= 0707 | (mode & 0007) << 3;
    // Without permissions, as on FAT, all files have the same.
    ::fchmod(descriptor, mode);
}

/// A file of its own in the folder of the target, which nobody may read who may not read the target.
NewFile create_beside(const fs::path& target) {
    const auto old = status_of(target);
    for (;;) {
        fs::path path = target.parent_path() / temporary_name();
        Descriptor file{open_file(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, old ? 0600 : 0666)};
        if (file.get() >= 0 && old) take_over_access(file.get(), *old);
        if (file.get() >= 0) return {std::move(path), std::move(file)};
        // Left by a process that was killed, or that of another container.
        if (errno != EEXIST) fail_write(target, errno);
    }
}

void rename_to(const fs::path& target, const fs::path& from) {
    if (::rename(from.c_str(), target.c_str()) != 0) fail_write(target, errno);
}

}  // namespace

fs::path real_target(fs::path path) {
    std::error_code ignored;
    constexpr int most_links = 40;  // as many as Linux follows
    for (int i = 0; i < most_links && fs::is_symlink(path, ignored) && !fs::exists(path, ignored); ++i)
        path = path.parent_path() / fs::read_symlink(path, ignored);
    const fs::path real = fs::weakly_canonical(path, ignored);
    return real.empty() ? path : real;
}

std::string temporary_name() {
    static std::atomic<unsigned> counter{0};
    return fmt::format("{}{}.{}{}", temporary_prefix, ::getpid(), counter++, temporary_suffix);
}

bool is_temporary_name(std::string_view name) {
    return name.starts_with(temporary_prefix) && name.ends_with(temporary_suffix);
}

void write_all(int descriptor, std::span<const std::byte> bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail_write(path, errno);
        bytes = bytes.subspan(size_t(written));
    }
}

void replace_file(const fs::path& target, const fs::path& by) {
    require_writable(target);
    rename_to(target, by);
}

FileSet::~FileSet() {
    for (const File& file : files_) ::unlink(file.beside.c_str());
}

void FileSet::add(const fs::path& path, std::span<const std::byte> bytes) {
    const fs::path target = real_target(path);
    File& file = files_.emplace_back(File{{}, target});
    NewFile created = create_beside(target);
    file.beside = std::move(created.path);
    write_all(created.file.get(), bytes, target);
}

void FileSet::add(const fs::path& path, std::string_view text) {
    add(path, std::as_bytes(std::span(text.data(), text.size())));
}

void FileSet::commit() {
    for (const File& file : files_) require_writable(file.target);
    while (!files_.empty()) {
        const File& file = files_.front();
        rename_to(file.target, file.beside);
        files_.erase(files_.begin());
    }
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
    FileSet file;
    file.add(path, bytes);
    file.commit();
}

void write_file(const fs::path& path, std::string_view text) {
    write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

void check_writable(const fs::path& given) {
    const fs::path target = real_target(given);
    require_writable(target);
    ::unlink(create_beside(target).path.c_str());
}

}  // namespace easypbr
