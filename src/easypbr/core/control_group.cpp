#include "easypbr/core/control_group.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/system_numbers.h"

namespace easypbr {
namespace {

namespace fs = std::filesystem;

/// The names of a controller's files in a version of cgroup.
struct MemoryFiles {
    const char *limit, *used, *active, *inactive;
};
constexpr MemoryFiles memory_v1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_active_file",
                                "total_inactive_file"};
constexpr MemoryFiles memory_v2{"memory.max", "memory.current", "active_file", "inactive_file"};

bool has_word(std::string_view list, std::string_view word) {
    while (!list.empty()) {
        const size_t comma = std::min(list.find(','), list.size());
        if (list.substr(0, comma) == word) return true;
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return false;
}

/// Calls visit(folder, is_v2) for the folder of each group that has a controller, from the process's own up
/// to the root of its hierarchy. In a container folders on the way may not be there, the root is.
template <class Visit>
void for_each_group(const fs::path& root, std::string_view controller, Visit&& visit) {
    const fs::path mounts = root / "sys/fs/cgroup";
    const auto walk_up = [&](const fs::path& mount, const fs::path& own, bool is_v2) {
        for (fs::path group = own.lexically_normal().relative_path(); !group.empty();
             group = group.parent_path())
            visit(mount / group, is_v2);
        visit(mount, is_v2);
    };
    std::ifstream groups(root / "proc/self/cgroup");
    // A hierarchy's number, its controllers (none: v2), the path of the process's group.
    for (std::string line; std::getline(groups, line);) {
        const size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == line.npos || second == line.npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const fs::path own = line.substr(second + 1);
        if (has_word(controllers, controller)) walk_up(mounts / controller, own, false);
        // Beside v1 it is mounted below it.
        if (controllers.empty()) {
            walk_up(mounts, own, true);
            walk_up(mounts / "unified", own, true);
        }
    }
}

uint64_t memory_left_in(const fs::path& group, const MemoryFiles& files) {
    const auto limit = number_in(group / files.limit), used = number_in(group / files.used);
    if (!limit || !used) return std::numeric_limits<uint64_t>::max();
    // Cached files are given up for memory that is asked for.
    const fs::path stat = group / "memory.stat";
    const uint64_t cached =
        number_after(stat, files.active).value_or(0) + number_after(stat, files.inactive).value_or(0);
    const uint64_t taken = cached < *used ? *used - cached : *used;
    return *limit > taken ? *limit - taken : 0;
}

/// Processors, as 1.5; infinite without a quota.
double quota_of(const fs::path& group, bool is_v2) {
    const auto quota = number_in(group / (is_v2 ? "cpu.max" : "cpu.cfs_quota_us"));
    const auto period = is_v2 && quota ? number_after(group / "cpu.max", std::to_string(*quota))
                                       : number_in(group / "cpu.cfs_period_us");
    return quota && period && *period > 0 ? double(*quota) / double(*period)
                                          : std::numeric_limits<double>::infinity();
}

}  // namespace

uint64_t memory_left_in_groups(const fs::path& root) {
    uint64_t least = std::numeric_limits<uint64_t>::max();
    for_each_group(root, "memory", [&](const fs::path& group, bool is_v2) {
        least = std::min(least, memory_left_in(group, is_v2 ? memory_v2 : memory_v1));
    });
    return least;
}

int threads_in_groups(const fs::path& root) {
    double least = std::numeric_limits<int>::max();
    for_each_group(root, "cpu", [&](const fs::path& group, bool is_v2) {
        least = std::min(least, std::ceil(quota_of(group, is_v2)));
    });
    return std::max(int(least), 1);
}

}  // namespace easypbr
