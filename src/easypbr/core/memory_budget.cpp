#include "easypbr/core/memory_budget.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "easypbr/core/control_group.h"
#include "easypbr/core/error.h"
#include "easypbr/core/system_numbers.h"

namespace easypbr {
namespace {

thread_local MemoryScope* innermost = nullptr;

constexpr uint64_t unlimited = std::numeric_limits<uint64_t>::max();

uint64_t left_of_addresses() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    const uint64_t used = number_in("/proc/self/statm").value_or(0) * uint64_t(::sysconf(_SC_PAGESIZE));
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
    const auto free_kb = number_after("/proc/meminfo", "MemAvailable:");
    const uint64_t free = free_kb ? *free_kb * 1024 : unlimited;
    return std::min({free, memory_left_in_groups(), left_of_addresses()}) / 4 * 3;
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
