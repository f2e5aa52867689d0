#include "easypbr/core/file.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/folder.h"
#include "easypbr/core/open_file.h"
#include "easypbr/core/opened_files.h"

namespace easypbr {
namespace {

/// Files of fewer bytes are copied, which costs less than what a map has to guard against. Copying hundreds
/// of megabytes would make loading a binary PLY a third slower.
constexpr size_t smallest_map = 1 << 20;

[[noreturn]] void fail_read(std::string_view path, std::string_view why) {
    throw FileError(fmt::format("cannot read {}: {}", path, why));
}

/// What a file is that is no regular one.
const char* kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return S_ISCHR(mode) || S_ISBLK(mode) ? "a device" : "of an unknown kind";
}

std::byte* allocate_pages(size_t size, std::string_view path) {
    void* pages = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) fail_read(path, fmt::format("no memory for its {} bytes", size));
    return static_cast<std::byte*>(pages);
}

/// Beneath the folder of a FolderScope where there is one.
Descriptor open_in_scope(const fs::path& path, int flags) {
    const Folder* const folder = FolderScope::current();
    if (!folder) return Descriptor(open_file(path.c_str(), flags));
    return folder->open(fs::absolute(path).lexically_normal().lexically_relative(folder->path()), flags);
}

fs::file_time_type change_time(const struct stat& info) {
    const timespec& time = info.st_mtim;
    return fs::file_time_type::clock::from_sys(std::chrono::sys_time<std::chrono::nanoseconds>(
        std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec)));
}

/// When a file was changed last that could not be opened, for `error`; the least time where it is missing.
/// Nothing for links that a folder cannot follow: what they lead to may be there all the time.
std::optional<fs::file_time_type> unopened_time(const fs::path& path, int error) {
    if (FolderScope::current() && (error == ELOOP || error == ENOTDIR)) return {};
    const Descriptor place = open_in_scope(path, O_PATH);
    struct stat info {};
    if (place.get() < 0 || ::fstat(place.get(), &info) != 0) return fs::file_time_type::min();
    return change_time(info);
}

/// Nothing outside of the folder of a FolderScope is even looked at.
Descriptor open_input(const fs::path& path) {
    Descriptor file = open_in_scope(path, O_RDONLY | O_NONBLOCK);
    const int error = errno;
    const Folder* const folder = FolderScope::current();
    if (folder && file.get() < 0 && error == EXDEV)
        fail_read(path.string(), fmt::format("it lies outside of the folder {}", folder->path().string()));
    OpenedFiles* const files = OpenedFilesScope::current();
    if (!files) return file;
    struct stat info {};
    const bool is_open = file.get() >= 0 && ::fstat(file.get(), &info) == 0;
    const std::optional<fs::file_time_type> time = is_open ? change_time(info) : unopened_time(path, error);
    if (time) files->add(path, *time);
    errno = error;
    return file;
}

/// Waits until there is something to read where that does not block.
void wait_for_input(int descriptor) {
    pollfd input{descriptor, POLLIN, 0};
    ::poll(&input, 1, -1);
}

}  // namespace

bool exists_in_scope(const fs::path& path) {
    std::error_code ignored;
    return FolderScope::current() ? open_in_scope(path, O_PATH).get() >= 0 : fs::exists(path, ignored);
}

Descriptor::~Descriptor() {
    if (value_ >= 0) ::close(value_);
}

InputFile::InputFile(fs::path path) : path_(std::move(path)), file_(open_input(path_)) {
    look();
}

InputFile::InputFile(Descriptor file, fs::path path) : path_(std::move(path)), file_(std::move(file)) {
    look();
}

void InputFile::look() {
    struct stat info {};
    // A socket cannot be opened at all.
    if (file_.get() < 0 && errno == ENXIO && ::stat(path_.c_str(), &info) == 0 && !S_ISREG(info.st_mode))
        fail_read(path_.string(), fmt::format("it is {}, not a regular file", kind_of(info.st_mode)));
    if (file_.get() < 0 || ::fstat(file_.get(), &info) != 0) fail_read(path_.string(), std::strerror(errno));
    if (!S_ISREG(info.st_mode))
        fail_read(path_.string(), fmt::format("it is {}, not a regular file", kind_of(info.st_mode)));
    state_ = {size_t(info.st_size), change_time(info)};
}

void InputFile::read(size_t from, std::span<std::byte> out) const {
    while (!out.empty()) {
        const ssize_t count = ::pread(file_.get(), out.data(), out.size(), off_t(from));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail_read(path_.string(), std::strerror(errno));
        if (count == 0)
            fail_read(path_.string(),
                      fmt::format("it was truncated while it was read: it had {} bytes, now it "
                                  "ends at byte {}",
                                  size(), from));
        from += size_t(count);
        out = out.subspan(size_t(count));
    }
}

void check_readable(const fs::path& path) {
    const InputFile file(path);
}

FileBytes::FileBytes(InputFile file) : file_(std::move(file)), size_(file_->size()) {
    if (size_ >= smallest_map) map_ = GuardedMap(file_->descriptor(), size_);
    if (map_)
        data_ = map_.data();
    else if (size_ > 0)
        copy();
}

void FileBytes::copy() {
    own_ = allocate_pages(size_, file_->path().string());
    data_ = own_;
    capacity_ = size_;
    try {
        file_->read(0, {own_, size_});
    } catch (...) {
        ::munmap(own_, capacity_);
        throw;
    }
}

FileBytes::FileBytes(int descriptor, std::string_view name) {
    FileBytes input;
    for (;;) {
        if (input.size_ == input.capacity_) input.grow(name);
        const ssize_t count = ::read(descriptor, input.own_ + input.size_, input.capacity_ - input.size_);
        if (count == 0) break;
        if (count > 0)
            input.size_ += size_t(count);
        else if (errno == EAGAIN)
            wait_for_input(descriptor);
        else if (errno != EINTR)
            fail_read(name, std::strerror(errno));
    }
    *this = std::move(input);
}

void FileBytes::grow(std::string_view name) {
    const size_t capacity = std::max(2 * capacity_, smallest_map);
    if (!own_) {
        own_ = allocate_pages(capacity, name);
    } else {
        void* pages = ::mremap(own_, capacity_, capacity, MREMAP_MAYMOVE);
        if (pages == MAP_FAILED) fail_read(name, fmt::format("no memory for more than {} bytes", capacity_));
        own_ = static_cast<std::byte*>(pages);
    }
    data_ = own_;
    capacity_ = capacity;
}

FileBytes::~FileBytes() {
    if (own_) ::munmap(own_, capacity_);
}

FileBytes::FileBytes(FileBytes&& other) noexcept {
    *this = std::move(other);
}

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(map_, other.map_);
    std::swap(own_, other.own_);
    std::swap(capacity_, other.capacity_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
}

void FileBytes::check() const {
    if (map_.is_broken())
        fail_read(
            file_->path().string(),
            fmt::format("it was truncated, or could not be read, while it was read: it had {} bytes", size_));
}

void FileBytes::release_until(size_t end) const {
    const size_t page = 1 << 16;
    const size_t whole = std::min(end, size_) / page * page;
    if (map_ && whole) ::madvise(const_cast<std::byte*>(data_), whole, MADV_DONTNEED);
}

std::string extension_of(const fs::path& path) {
    std::string extension = path.extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    return ascii::to_lower(extension);
}

}  // namespace easypbr
