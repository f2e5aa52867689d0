// Opening a file where signals interrupt that, as they may on network file systems.
#pragma once

#include <fcntl.h>

#include <cerrno>

namespace easypbr {

/// open() with O_CLOEXEC, again as long as it is interrupted; -1 and errno where it cannot be opened.
inline int open_file(const char* path, int flags, mode_t mode = 0) {
    int file;
    do file = ::open(path, flags | O_CLOEXEC, mode);
    while (file < 0 && errno == EINTR);
    return file;
}

/// The same for a name in an open folder. A link at its end is not followed: ELOOP.
inline int open_file_in(int folder, const char* name, int flags, mode_t mode = 0) {
    int file;
    do file = ::openat(folder, name, flags | O_NOFOLLOW | O_CLOEXEC, mode);
    while (file < 0 && errno == EINTR);
    return file;
}

}  // namespace easypbr
