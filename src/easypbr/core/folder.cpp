#include "easypbr/core/folder.h"

#include <dirent.h>
#include <fmt/format.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/markup.h"
#include "easypbr/core/open_file.h"

namespace easypbr {
namespace {

thread_local const Folder* innermost_folder = nullptr;

[[noreturn]] void fail_folder(const fs::path& path, std::string_view why) {
    throw FileError(fmt::format("cannot read {}: {}", path.string(), why));
}

/// -1 and ENOSYS or EPERM where the system, or a sandbox, has no openat2().
int open_beneath(int folder, const char* path, int flags) {
    open_how how{};
    how.flags = uint64_t(unsigned(flags | O_CLOEXEC));
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
    // EAGAIN: something was renamed meanwhile, so that the way could not be told to stay beneath.
    constexpr int most_tries = 100;
    long file = -1;
    for (int i = 0; i < most_tries; ++i) {
        file = ::syscall(SYS_openat2, folder, path, &how, sizeof how);
        if (file >= 0 || (errno != EAGAIN && errno != EINTR)) break;
    }
    return int(file);
}

}  // namespace

Folder::Folder(const fs::path& path)
    : path_(path.empty() ? path : fs::absolute(path).lexically_normal()),
      folder_(open_file(path.c_str(), O_RDONLY | O_DIRECTORY | O_NONBLOCK)) {
    if (!path_.has_filename() && path_.has_relative_path()) path_ = path_.parent_path();
    if (folder_.get() < 0) fail_folder(path, std::strerror(errno));
}

Descriptor Folder::open(const fs::path& relative, int flags) const {
    const int file = open_beneath(folder_.get(), relative.empty() ? "." : relative.c_str(), flags);
    if (file < 0 && (errno == ENOSYS || errno == EPERM)) return open_in_steps(relative, flags);
    return Descriptor(file);
}

Descriptor Folder::open_in_steps(const fs::path& relative, int flags) const {
    Descriptor at{open_file_in(folder_.get(), ".", O_PATH | O_DIRECTORY)};
    if (relative.is_absolute() || std::ranges::find(relative, "..") != relative.end()) {
        errno = EXDEV;
        return Descriptor();
    }
    for (auto name = relative.begin(); name != relative.end() && at.get() >= 0; ++name) {
        const bool is_last = std::next(name) == relative.end();
        at = Descriptor(open_file_in(at.get(), name->empty() ? "." : name->c_str(),
                                     is_last ? flags : O_PATH | O_DIRECTORY));
    }
    return relative.empty() ? Descriptor(open_file_in(folder_.get(), ".", flags)) : std::move(at);
}

std::vector<FolderEntry> Folder::list(const fs::path& relative) const {
    const Descriptor here = open(relative, O_RDONLY | O_DIRECTORY);
    if (here.get() < 0) fail_folder(path_ / relative, std::strerror(errno));
    // Closed by closedir().
    const int read = ::fcntl(here.get(), F_DUPFD_CLOEXEC, 0);
    const std::unique_ptr<DIR, int (*)(DIR*)> folder(read < 0 ? nullptr : ::fdopendir(read), ::closedir);
    if (!folder) fail_folder(path_ / relative, std::strerror(errno));
    std::vector<FolderEntry> entries;
    while (const dirent* found = ::readdir(folder.get())) {
        const std::string name = found->d_name;
        if (name.starts_with('.') || valid_utf8(name) != name) continue;
        struct stat info {};
        // A link may lead out, or nowhere.
        const bool is_link =
            ::fstatat(here.get(), name.c_str(), &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(info.st_mode);
        if (is_link) {
            const Descriptor target = open(relative / name, O_PATH);
            if (target.get() < 0 || ::fstat(target.get(), &info) != 0) continue;
        }
        if (S_ISDIR(info.st_mode))
            entries.push_back({name, true, 0});
        else if (S_ISREG(info.st_mode))
            entries.push_back({name, false, uint64_t(info.st_size)});
    }
    std::ranges::sort(entries, [](const FolderEntry& a, const FolderEntry& b) {
        return a.is_folder != b.is_folder ? a.is_folder : a.name < b.name;
    });
    return entries;
}

FolderScope::FolderScope(const Folder* folder) : outer_(std::exchange(innermost_folder, folder)) {}

FolderScope::~FolderScope() {
    innermost_folder = outer_;
}

const Folder* FolderScope::current() {
    return innermost_folder;
}

}  // namespace easypbr
