// Limits of the control groups that the process is in: those of containers, services and batch jobs.
#pragma once

#include <cstdint>
#include <filesystem>

namespace easypbr {

/// Bytes that the process may still take in its group and in all above it, of cgroup v1 and v2; UINT64_MAX
/// where none has a limit. Cached files do not count as taken. `root` is the folder that has /proc and /sys.
uint64_t memory_left_in_groups(const std::filesystem::path& root = "/");

/// Threads that the groups' shares of the processors keep busy: the smallest quota, rounded up; INT_MAX where
/// none has one.
int threads_in_groups(const std::filesystem::path& root = "/");

}  // namespace easypbr
