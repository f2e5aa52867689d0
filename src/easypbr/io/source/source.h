// The bytes of a file that is being read, what messages call it, and how far the reading has come.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "easypbr/core/file.h"

namespace easypbr::io {

/// Bytes to decode and the path they came from. `file` is null when the bytes do not come from a file.
struct Source {
    std::string_view bytes;
    fs::path path;
    const FileBytes* file = nullptr;

    Source(const FileBytes& read, fs::path from) : bytes(read.text()), path(std::move(from)), file(&read) {}
    Source(std::string_view text, fs::path from) : bytes(text), path(std::move(from)) {}

    /// The bytes from a place on.
    Source from(size_t place) const { return {bytes.substr(place), path}; }

    const char* begin() const { return bytes.data(); }
    const char* end() const { return bytes.data() + bytes.size(); }

    /// Bytes before `place` are not needed again soon.
    void release_until(const char* place) const {
        if (file) file->release_until(size_t(place - begin()));
    }
};

/// Throws FormatError "PATH: byte N: MESSAGE".
[[noreturn]] void fail_at_byte(const Source& source, const char* place, std::string_view message);

/// Throws FormatError "PATH:LINE: MESSAGE".
[[noreturn]] void fail_at_line(const Source& source, const char* place, std::string_view message);

/// Throws FormatError "PATH: MESSAGE".
[[noreturn]] void fail(const Source& source, std::string_view message);

/// Reports the part of a large file (over 50 MB) that has been read; silent for smaller ones. Thread-safe.
class Progress {
  public:
    Progress(const Source& source, size_t total_bytes);

    /// `bytes` more have been read.
    void advance(size_t bytes);

  private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    size_t total_;
    std::atomic<size_t> done_{0};
    std::mutex mutex_;
    Clock::time_point last_ = Clock::now();
};

}  // namespace easypbr::io
