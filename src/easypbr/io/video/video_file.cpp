#include "easypbr/io/video/video_file.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file_set.h"
#include "easypbr/core/open_file.h"

namespace easypbr::io {
namespace {

constexpr mode_t usual_access = 0666;

using Lock = struct flock;

/// A lock of one byte that no video reaches: where locks are mandatory, as on SMB, an encoder writes all
/// others through a descriptor of its own. It belongs to the open file, so that two of one process exclude
/// each other.
Lock lock_of(short type) {
    Lock lock{};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    lock.l_start = off_t(1) << 62;
    lock.l_len = 1;
    return lock;
}

void set_lock(int file, short type) {
    Lock lock = lock_of(type);
    // Some file systems have no locks; the names alone keep videos apart there.
    ::fcntl(file, F_OFD_SETLK, &lock);
}

/// "clip.part.mp4" beside "clip.mp4", then "clip.part-2.mp4".
fs::path part_path(const fs::path& target, int number) {
    const std::string count = number > 1 ? fmt::format("-{}", number) : "";
    fs::path part = target;
    return part.replace_extension(fmt::format(".part{}{}", count, target.extension().string()));
}

/// A new file's group may be another than that of the target: it gets no more than everybody.
mode_t access_beside(const fs::path& target) {
    struct stat info {};
    if (::stat(target.c_str(), &info) != 0) return usual_access;
    const mode_t others = info.st_mode & 0006;
    return 0600 | (info.st_mode & others << 3) | others;
}

}  // namespace

VideoFile::VideoFile(fs::path name, fs::path path, Descriptor file)
    : name_(std::move(name)), path_(std::move(path)), file_(std::move(file)) {}

std::optional<VideoFile> VideoFile::create_at(const fs::path& name, const fs::path& path, mode_t mode) {
    Descriptor file{open_file(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, mode)};
    const int error = file.get() < 0 ? errno : 0;
    if (error == EEXIST) return std::nullopt;
    if (error != 0) {
        // A name that fits may be too long for the file beside it.
        const bool is_given = path.filename() == name.filename();
        const std::string part = is_given ? "" : fmt::format("{}: ", path.filename().string());
        throw FileError(fmt::format("cannot write {}: {}{}", name.string(), part, std::strerror(error)));
    }
    set_lock(file.get(), F_WRLCK);
    return VideoFile(name, path, std::move(file));
}

std::optional<VideoFile> VideoFile::create(const fs::path& path) {
    std::error_code ignored;
    const fs::path place = fs::is_symlink(path, ignored) ? real_target(path) : path;
    // The program's folder may be another one when the file is finished.
    return create_at(path, fs::absolute(place), usual_access);
}

VideoFile VideoFile::create_part(const fs::path& target, const fs::path& name) {
    const mode_t mode = access_beside(target);
    for (int number = 1;; ++number) {
        const fs::path part = part_path(target, number);
        if (auto file = create_at(name, fs::absolute(part), mode)) return std::move(*file);
    }
}

VideoFile VideoFile::create_temporary(const fs::path& target) {
    for (;;) {
        const fs::path path = fs::absolute(target).parent_path() / temporary_name();
        // The name is there where it was left by a process that was killed, or that of another container.
        if (auto file = create_at(target, path, 0600)) return std::move(*file);
    }
}

VideoFile::~VideoFile() {
    remove();
}

bool VideoFile::is_in_place() const {
    struct stat own {
    }, there{};
    return ::fstat(file_.get(), &own) == 0 && ::lstat(path_.c_str(), &there) == 0 &&
           own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

void VideoFile::require_in_place() const {
    if (!is_in_place())
        throw FileError(fmt::format("cannot write {}: {} was removed or replaced while it was written",
                                    name_.string(), path_.filename().string()));
}

void VideoFile::release() {
    // A child process that was forked meanwhile has the descriptor too, which would keep the lock.
    set_lock(file_.get(), F_UNLCK);
    file_ = Descriptor();
}

void VideoFile::keep() {
    require_in_place();
    release();
}

void VideoFile::replace(const fs::path& target) {
    require_in_place();
    replace_file(target, path_);
    release();
}

void VideoFile::remove() {
    if (file_.get() < 0) return;
    if (is_in_place()) ::unlink(path_.c_str());
    release();
}

bool is_being_recorded(const fs::path& path) {
    const Descriptor file{open_file(path.c_str(), O_RDONLY | O_NONBLOCK)};
    Lock lock = lock_of(F_WRLCK);
    return file.get() >= 0 && ::fcntl(file.get(), F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

}  // namespace easypbr::io
