#include "easypbr/core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "easypbr/core/error.h"

namespace easypbr {
namespace {

/// Closes a file descriptor at the end of a scope.
struct Descriptor {
    int value;
    ~Descriptor() {
        if (value >= 0) ::close(value);
    }
};

fs::path temporary_beside(const fs::path& path) {
    static std::atomic<unsigned> counter{0};
    return path.parent_path() / fmt::format(".{}.{}.{}.tmp", path.filename().string(), ::getpid(), counter++);
}

[[noreturn]] void fail_write(const fs::path& path, int error) {
    throw FileError(fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
}

void write_all(int descriptor, std::span<const std::byte> bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail_write(path, errno);
        bytes = bytes.subspan(size_t(written));
    }
}

}  // namespace

MappedFile::MappedFile(const fs::path& path) {
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.value < 0)
        throw FileError(fmt::format("cannot read {}: {}", path.string(), std::strerror(errno)));
    struct stat info {};
    if (::fstat(file.value, &info) != 0)
        throw FileError(fmt::format("cannot read {}: {}", path.string(), std::strerror(errno)));
    if (!S_ISREG(info.st_mode))
        throw FileError(fmt::format("cannot read {}: not a regular file", path.string()));
    size_ = size_t(info.st_size);
    if (size_ == 0) return;
    data_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.value, 0);
    if (data_ == MAP_FAILED) {
        data_ = nullptr;
        throw FileError(fmt::format("cannot map {}: {}", path.string(), std::strerror(errno)));
    }
    ::madvise(data_, size_, MADV_WILLNEED);
}

MappedFile::~MappedFile() {
    if (data_) ::munmap(data_, size_);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
}

void MappedFile::release_until(size_t end) const {
    const size_t page = 1 << 16;
    const size_t whole = std::min(end, size_) / page * page;
    if (data_ && whole) ::madvise(data_, whole, MADV_DONTNEED);
}

namespace {

/// Where a file is really written: a link stays a link.
fs::path real_target(const fs::path& path) {
    std::error_code ignored;
    const fs::path real = fs::weakly_canonical(path, ignored);
    return real.empty() ? path : real;
}

}  // namespace

void write_file(const fs::path& given, std::span<const std::byte> bytes) {
    const fs::path path = real_target(given);
    const fs::path beside = temporary_beside(path);
    try {
        const Descriptor file{::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)};
        if (file.value < 0) fail_write(path, errno);
        write_all(file.value, bytes, path);
    } catch (...) {
        ::unlink(beside.c_str());
        throw;
    }
    if (::rename(beside.c_str(), path.c_str()) != 0) {
        const int error = errno;
        ::unlink(beside.c_str());
        fail_write(path, error);
    }
}

void write_file(const fs::path& path, std::string_view text) {
    write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

void check_writable(const fs::path& given) {
    const fs::path path = real_target(given);
    if (fs::exists(path) && ::access(path.c_str(), W_OK) != 0) fail_write(path, errno);
    if (path.filename().empty() || fs::is_directory(path)) fail_write(path, EISDIR);
    const fs::path beside = temporary_beside(path);
    const Descriptor file{::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)};
    if (file.value < 0) fail_write(path, errno);
    ::unlink(beside.c_str());
}

std::string extension_of(const fs::path& path) {
    std::string extension = path.extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

}  // namespace easypbr
