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

    /// The same without a byte order mark of UTF-8, which some editors put before text.
    Source without_mark() const {
        constexpr std::string_view mark = "\xef\xbb\xbf";
        Source text = *this;
        if (bytes.starts_with(mark)) text.bytes.remove_prefix(mark.size());
        return text;
    }

    const char* begin() const { return bytes.data(); }
    const char* end() const { return bytes.data() + bytes.size(); }

    /// Bytes before `place` are not needed again soon.
    void release_until(const char* place) const {
        if (file) file->release_until(size_t(place - begin()));
    }
};

/// Text of which nothing is binary: without a byte order mark, and with line feeds in place of the carriage
/// returns that alone end the lines of old Macintosh files.
class TextSource {
  public:
    /// What is changed is a copy, else `given` is used and must live on. Throws FormatError when there is no
    /// memory for a copy (core/memory_budget.h).
    explicit TextSource(const Source& given);
    TextSource(const TextSource&) = delete;
    TextSource& operator=(const TextSource&) = delete;

    const Source& source() const { return source_; }

  private:
    std::string copy_;
    Source source_;
};

/// "PATH:LINE" of a place in the text.
std::string line_name(const Source& source, const char* place);

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
    bool given_up_ = false;  ///< the sink threw; guarded by mutex_
};

}  // namespace easypbr::io
