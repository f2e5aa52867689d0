#include "easypbr/core/control_group.h"

#include <gtest/gtest.h>

#include <climits>
#include <cstdint>
#include <fstream>
#include <string>

#include "io/temporary_folder.h"

namespace easypbr::control_group_test {
namespace {

/// A folder with the files of /proc and /sys that a machine would have.
class ControlGroups : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) {
        const std::filesystem::path path = root_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    /// The files of a group of v2, whose cached files are reclaimable.
    void write_memory(const std::string& group, const std::string& most, int used, int cached) {
        const std::string folder = "sys/fs/cgroup" + group + "/";
        write(folder + "memory.max", most + "\n");
        write(folder + "memory.current", std::to_string(used) + "\n");
        // In tmpfs files have nowhere to go: "file" has them too.
        write(folder + "memory.stat", "anon 5\nfile " + std::to_string(cached + 7) +
                                          "\nshmem 7\ninactive_file " + std::to_string(cached - 10) +
                                          "\nactive_file 10\n");
    }

    TemporaryFolder root_;
};

TEST_F(ControlGroups, HaveNoLimitWhereThereAreNone) {
    EXPECT_EQ(memory_left_in_groups(root_.path()), UINT64_MAX);
    EXPECT_EQ(threads_in_groups(root_.path()), INT_MAX);
    write("proc/self/cgroup", "damaged\n0::/\n");
    write_memory("", "max", 1000, 100);
    write("sys/fs/cgroup/cpu.max", "max 100000\n");
    EXPECT_EQ(memory_left_in_groups(root_.path()), UINT64_MAX);
    EXPECT_EQ(threads_in_groups(root_.path()), INT_MAX);
}

TEST_F(ControlGroups, OfV2CountFromTheProcesssOwnToTheRoot) {
    write("proc/self/cgroup", "0::/system.slice/job.service\n");
    write_memory("/system.slice/job.service", "5000", 3000, 500);
    EXPECT_EQ(memory_left_in_groups(root_.path()), 5000u - (3000 - 500));
    // Not one beside it.
    write_memory("/system.slice/other.service", "100", 50, 20);
    EXPECT_EQ(memory_left_in_groups(root_.path()), 2500u);
    write_memory("/system.slice", "7000", 6000, 100);
    EXPECT_EQ(memory_left_in_groups(root_.path()), 1100u);
    write_memory("", "1000", 1000, 20);
    EXPECT_EQ(memory_left_in_groups(root_.path()), 20u);
    write_memory("", "1000", 1500, 20);
    EXPECT_EQ(memory_left_in_groups(root_.path()), 0u);

    write("sys/fs/cgroup/system.slice/job.service/cpu.max", "250000 100000\n");
    EXPECT_EQ(threads_in_groups(root_.path()), 3);
    write("sys/fs/cgroup/system.slice/cpu.max", "200000 100000\n");
    EXPECT_EQ(threads_in_groups(root_.path()), 2);
    write("sys/fs/cgroup/cpu.max", "10000 100000\n");
    EXPECT_EQ(threads_in_groups(root_.path()), 1);
}

// As `docker run -m` has it: the group's folder is mounted as the root.
TEST_F(ControlGroups, OfAContainerAreItsRoot) {
    write("proc/self/cgroup", "0::/\n");
    write_memory("", "5000", 3000, 500);
    EXPECT_EQ(memory_left_in_groups(root_.path()), 2500u);
}

// Beside v1, v2 has no controllers, and in a container the group's path is that outside.
TEST_F(ControlGroups, OfV1AreInFoldersOfTheirControllers) {
    write("proc/self/cgroup",
          "5:memory:/docker/abc\n4:cpu,cpuacct:/docker/abc\n3:cpuset:/docker/abc\n0::/\n");
    write("sys/fs/cgroup/memory/memory.limit_in_bytes", "5000\n");
    write("sys/fs/cgroup/memory/memory.usage_in_bytes", "3000\n");
    write("sys/fs/cgroup/memory/memory.stat", "cache 1\ntotal_inactive_file 300\ntotal_active_file 200\n");
    EXPECT_EQ(memory_left_in_groups(root_.path()), 2500u);
    write("sys/fs/cgroup/memory/docker/abc/memory.limit_in_bytes", "3500\n");
    write("sys/fs/cgroup/memory/docker/abc/memory.usage_in_bytes", "3000\n");
    EXPECT_EQ(memory_left_in_groups(root_.path()), 500u);

    write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1\n");
    write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(threads_in_groups(root_.path()), INT_MAX);
    write("sys/fs/cgroup/cpu/docker/abc/cpu.cfs_quota_us", "150000\n");
    write("sys/fs/cgroup/cpu/docker/abc/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(threads_in_groups(root_.path()), 2);
}

}  // namespace
}  // namespace easypbr::control_group_test
