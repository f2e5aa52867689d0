#include "easypbr/core/file_set.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "easypbr/core/error.h"
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

/// Whether a file can be written though its folder takes no other: it may be mounted there by itself.
bool can_be_written_into(const fs::path& target, int folder_error) {
    const bool is_refused = folder_error == EACCES || folder_error == EPERM || folder_error == EROFS;
    return is_refused && ::access(target.c_str(), W_OK) == 0;
}

/// A file of its own in the folder of the target, which nobody may read who may not read the target. None
/// where the target can only be written into.
NewFile create_beside(const fs::path& target) {
    const auto old = status_of(target);
    for (;;) {
        fs::path path = target.parent_path() / temporary_name();
        Descriptor file{open_file(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, old ? 0600 : 0666)};
        if (file.get() >= 0 && old) take_over_access(file.get(), *old);
        const int error = errno;
        if (file.get() >= 0) return {std::move(path), std::move(file)};
        if (can_be_written_into(target, error)) return {fs::path(), Descriptor()};
        // Left by a process that was killed, or that of another container.
        if (error != EEXIST) fail_write(target, error);
    }
}

Descriptor file_in_memory(const fs::path& target) {
    Descriptor file{::memfd_create("easypbr", MFD_CLOEXEC)};
    if (file.get() < 0) fail_write(target, errno);
    return file;
}

/// Puts all bytes of an open file into one that is there.
void copy_into(const fs::path& target, int from) {
    const Descriptor file{open_file(target.c_str(), O_WRONLY | O_TRUNC | O_NOFOLLOW | O_NONBLOCK)};
    if (file.get() < 0) fail_write(target, errno);
    std::vector<std::byte> part(1 << 16);
    for (off_t at = 0;;) {
        const ssize_t count = ::pread(from, part.data(), part.size(), at);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail_write(target, errno);
        if (count == 0) return;
        write_all(file.get(), std::span(part).first(size_t(count)), target);
        at += count;
    }
}

/// Puts a file in the place of the target. One that is mounted, or another user's in a sticky folder, keeps
/// its place and gets the bytes.
void move_over(const fs::path& target, const fs::path& beside) {
    if (::rename(beside.c_str(), target.c_str()) == 0) return;
    if (errno != EPERM && errno != EBUSY && errno != EXDEV) fail_write(target, errno);
    const Descriptor file{open_file(beside.c_str(), O_RDONLY)};
    if (file.get() < 0) fail_write(target, errno);
    copy_into(target, file.get());
    ::unlink(beside.c_str());
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
    if (const auto old = status_of(target)) {
        const Descriptor file{open_file(by.c_str(), O_WRONLY)};
        if (file.get() >= 0) take_over_access(file.get(), *old);
    }
    move_over(target, by);
}

FileSet::~FileSet() {
    for (const File& file : files_)
        if (!file.beside.empty()) ::unlink(file.beside.c_str());
}

void FileSet::add(const fs::path& path, std::span<const std::byte> bytes) {
    const fs::path target = real_target(path);
    // Nothing fails between the file's creation and its entry.
    files_.reserve(files_.size() + 1);
    File file{{}, target, Descriptor()};
    NewFile created = create_beside(target);
    file.beside = std::move(created.path);
    if (file.beside.empty()) file.in_memory = file_in_memory(target);
    const int descriptor = file.beside.empty() ? file.in_memory.get() : created.file.get();
    files_.push_back(std::move(file));
    write_all(descriptor, bytes, target);
}

void FileSet::add(const fs::path& path, std::string_view text) {
    add(path, std::as_bytes(std::span(text.data(), text.size())));
}

void FileSet::commit() {
    for (const File& file : files_) require_writable(file.target);
    while (!files_.empty()) {
        const File& file = files_.front();
        if (file.beside.empty())
            copy_into(file.target, file.in_memory.get());
        else
            move_over(file.target, file.beside);
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
    const NewFile beside = create_beside(target);
    if (!beside.path.empty()) ::unlink(beside.path.c_str());
}

}  // namespace easypbr
