#include "easypbr/io/source/source.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"

namespace easypbr::io {

TextSource::TextSource(const Source& given) : source_(given.without_mark()) {
    const std::string_view text = source_.bytes;
    if (text.find('\n') != text.npos || text.find('\r') == text.npos) return;
    charge_memory(text.size(), "its text");
    copy_ = text;
    std::ranges::replace(copy_, '\r', '\n');
    source_ = Source(std::string_view(copy_), given.path);
}

void fail_at_byte(const Source& source, const char* place, std::string_view message) {
    throw FormatError(fmt::format("{}: byte {}: {}", source.path.string(), place - source.begin(), message));
}

std::string line_name(const Source& source, const char* place) {
    return fmt::format("{}:{}", source.path.string(), 1 + std::count(source.begin(), place, '\n'));
}

void fail_at_line(const Source& source, const char* place, std::string_view message) {
    throw FormatError(fmt::format("{}: {}", line_name(source, place), message));
}

void fail(const Source& source, std::string_view message) {
    throw FormatError(fmt::format("{}: {}", source.path.string(), message));
}

Progress::Progress(const Source& source, size_t total_bytes)
    : what_(fmt::format("reading {}", source.path.filename().string())), total_(total_bytes) {}

void Progress::advance(size_t bytes) {
    constexpr size_t smallest_reported = 50'000'000;
    const size_t done = done_ += bytes;
    if (total_ < smallest_reported) return;
    // The end is always reported, what lies between a few times per second.
    const bool at_end = done >= total_;
    std::unique_lock lock(mutex_, std::defer_lock);
    if (at_end)
        lock.lock();
    else if (!lock.try_lock() || Clock::now() - last_ < std::chrono::milliseconds(250))
        return;
    // Chunks that other threads read meanwhile may still come to the end.
    if (given_up_) return;
    last_ = Clock::now();
    try {
        report_progress(what_, std::min(1.0, double(done) / double(total_)));
    } catch (...) {
        given_up_ = true;
        throw;
    }
}

}  // namespace easypbr::io
