#include "easypbr/core/memory_budget.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "easypbr/core/error.h"

namespace easypbr {
namespace {

thread_local MemoryScope* innermost = nullptr;

constexpr uint64_t unlimited = std::numeric_limits<uint64_t>::max();

/// The number that follows a word in a text file; `unlimited` where there is none.
uint64_t number_after(const char* path, const std::string& word) {
    std::ifstream file(path);
    std::string found;
    while (file >> found) {
        uint64_t number = 0;
        if (found == word && file >> number) return number;
    }
    return unlimited;
}

/// The only number of a file; `unlimited` where it says "max" or is not there.
uint64_t number_in(const char* path) {
    std::ifstream file(path);
    uint64_t number = 0;
    return file >> number ? number : unlimited;
}

/// What the control group of the process may still take (cgroup v2, "memory.max").
uint64_t left_in_group() {
    const uint64_t most = number_in("/sys/fs/cgroup/memory.max");
    const uint64_t used = number_in("/sys/fs/cgroup/memory.current");
    if (most == unlimited || used == unlimited) return unlimited;
    // Cached files are given up for memory that is asked for.
    const uint64_t cached = number_after("/sys/fs/cgroup/memory.stat", "file");
    const uint64_t taken = cached < used ? used - cached : used;
    return most > taken ? most - taken : 0;
}

uint64_t left_of_addresses() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    const uint64_t used_pages = number_in("/proc/self/statm");
    const uint64_t used = used_pages == unlimited ? 0 : used_pages * 4096;
    return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

std::string size_text(uint64_t bytes) {
    if (bytes < 1000) return fmt::format("{} bytes", bytes);
    if (bytes < 1'000'000) return fmt::format("{:.0f} kB", double(bytes) / 1e3);
    const double mb = double(bytes) / 1e6;
    return mb < 1000 ? fmt::format("{:.0f} MB", mb) : fmt::format("{:.1f} GB", mb / 1000);
}

}  // namespace

uint64_t automatic_memory_limit() {
    const uint64_t free_kb = number_after("/proc/meminfo", "MemAvailable:");
    const uint64_t free = free_kb == unlimited ? unlimited : free_kb * 1024;
    return std::min({free, left_in_group(), left_of_addresses()}) / 4 * 3;
}

MemoryScope::MemoryScope(std::string name, uint64_t limit)
    : name_(std::move(name)), left_(limit), limit_(limit), outer_(innermost), shares_(limit == 0 && outer_) {
    if (limit == 0 && !outer_) limit_ = left_ = automatic_memory_limit();
    innermost = this;  // Last: what throws before leaves nothing behind.
}

MemoryScope::~MemoryScope() {
    innermost = outer_;
}

void charge_memory(uint64_t bytes, std::string_view what) {
    const std::string name = innermost ? innermost->name_ + ": " : "";
    MemoryScope* scope = innermost;
    while (scope && scope->shares_) scope = scope->outer_;
    const uint64_t limit = scope ? scope->limit_ : automatic_memory_limit();
    const uint64_t left = scope ? scope->left_ : limit;
    if (bytes > left)
        throw FormatError(
            fmt::format("{}{} would take {}, and of the {} that reading may take {} are left (limits.memory)",
                        name, what, size_text(bytes), size_text(limit), size_text(left)));
    if (scope) scope->left_ -= bytes;
}

}  // namespace easypbr
