#include "easypbr/core/file_set.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/open_file.h"

namespace easypbr {
namespace {

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

/// A file that is renamed over a device or a pipe would take its place.
void require_no_special_file(const fs::path& target) {
    std::error_code ignored;
    const fs::file_status status = fs::status(target, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
        throw FileError(fmt::format("cannot write {}: it is a device, a pipe or a socket", target.string()));
}

void require_writable(const fs::path& target) {
    require_no_special_file(target);
    if (fs::exists(target) && ::access(target.c_str(), W_OK) != 0) fail_write(target, errno);
    if (target.filename().empty() || fs::is_directory(target)) fail_write(target, EISDIR);
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

void replace_file(const fs::path& target, const fs::path& by) {
    require_writable(target);
    rename_to(target, by);
}

FileSet::~FileSet() {
    for (const File& file : files_) ::unlink(file.beside.c_str());
}

void FileSet::add(const fs::path& path, std::span<const std::byte> bytes) {
    const fs::path target = real_target(path);
    require_no_special_file(target);
    const fs::path& beside = files_.emplace_back(File{temporary_beside(target), target}).beside;
    const Descriptor file{open_file(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666)};
    if (file.get() < 0) fail_write(target, errno);
    write_all(file.get(), bytes, target);
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
    const fs::path path = real_target(given);
    require_writable(path);
    const fs::path beside = temporary_beside(path);
    const Descriptor file{open_file(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666)};
    if (file.get() < 0) fail_write(path, errno);
    ::unlink(beside.c_str());
}

}  // namespace easypbr
