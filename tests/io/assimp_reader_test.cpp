// Files that assimp does not survive: the reader's process ends, this one goes on.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/io/mesh/assimp/assimp_loader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_queue.h"
#include "io/assimp_files.h"
#include "io/temporary_folder.h"

namespace easypbr::io::assimp_reader_test {
namespace {

using Clock = std::chrono::steady_clock;

/// A limit of a second, and all that a busy machine may add; without a limit the files would take for ever.
constexpr std::chrono::seconds soon(20);

size_t open_descriptors() {
    return size_t(std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

bool has_children() {
    return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

class AssimpReader : public testing::Test {
  protected:
    void SetUp() override {
#ifndef EASYPBR_HAS_ASSIMP
        GTEST_SKIP() << "left out: built without the assimp reader";
#endif
        ASSERT_FALSE(assimp_extensions().empty()) << "the assimp reader does not answer";
        write_file(folder / "good.ac", ac3d_file);
        write_file(folder / "crash.ase", crashing_ase);
        write_file(folder / "abort.nff", aborting_nff);
        write_file(folder / "huge.nff", huge_nff);
        write_file(folder / "endless.smd", endless_smd);
    }

    /// What the error about a file says.
    std::string error_of(const char* name, const AssimpLimits& limits = {}) const {
        try {
            load_assimp(folder / name, limits);
        } catch (const FormatError& error) {
            return error.what();
        }
        ADD_FAILURE() << name << " was read";
        return {};
    }
    std::string expected(const char* name, const std::string& what) const {
        return "cannot read " + (folder / name).string() + ": the assimp reader " + what;
    }

    const TemporaryFolder folder;
};

TEST_F(AssimpReader, NamesTheFileThatCrashedIt) {
    EXPECT_EQ(error_of("crash.ase"), expected("crash.ase", "crashed (signal 11)"));
    testing::internal::CaptureStderr();
    EXPECT_EQ(error_of("abort.nff"), expected("abort.nff", "crashed (signal 6)"));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "")
        << "what the standard library says of the assertion";
}

TEST_F(AssimpReader, EndsWithItsTime) {
    const auto start = Clock::now();
    EXPECT_EQ(error_of("endless.smd", {.seconds = 0.5}), expected("endless.smd", "took longer than 0.5 s"));
    EXPECT_LT(Clock::now() - start, soon);
}

TEST_F(AssimpReader, EndsWithItsMemory) {
    const auto start = Clock::now();
    EXPECT_EQ(error_of("huge.nff", {.bytes = 300'000'000}),
              expected("huge.nff", "needs more than 300000000 bytes of memory"));
    EXPECT_LT(Clock::now() - start, soon);
}

TEST_F(AssimpReader, HasMoreOfBothForLargerFiles) {
    const AssimpLimits small = assimp_limits(0), large = assimp_limits(1 << 30);
    EXPECT_EQ(small.seconds, 60);
    EXPECT_GT(large.seconds, 2 * small.seconds);
    EXPECT_GT(large.bytes, uint64_t(20) << 30);
}

TEST_F(AssimpReader, ReadsOnSeveralThreads) {
    std::vector<std::thread> threads;
    std::atomic<int> read = 0, crashed = 0;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&, i] {
            for (int k = 0; k < 5; ++k) try {
                    load_assimp(folder / ((i + k) % 2 ? "crash.ase" : "good.ac"));
                    ++read;
                } catch (const FormatError&) {
                    ++crashed;
                }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(read, 10);
    EXPECT_EQ(crashed, 10);
}

TEST_F(AssimpReader, LeavesNothingBehind) {
    const size_t before = open_descriptors();
    load_assimp(folder / "good.ac");
    error_of("crash.ase");
    error_of("endless.smd", {.seconds = 0.1});
    error_of("huge.nff", {.bytes = 300'000'000});
    EXPECT_EQ(open_descriptors(), before);
    EXPECT_FALSE(has_children());
}

TEST_F(AssimpReader, IsEndedByAnInterrupt) {
    const auto start = Clock::now();
    {
        const InterruptScope scope([&] { return Clock::now() - start > std::chrono::milliseconds(200); });
        EXPECT_THROW(load_assimp(folder / "endless.smd"), Interrupted);
    }
    EXPECT_LT(Clock::now() - start, soon);
    EXPECT_FALSE(has_children());
}

// A queue that is left early does not wait for the time limit.
TEST_F(AssimpReader, IsEndedWithTheQueue) {
    const auto start = Clock::now();
    {
        MeshQueue queue({folder / "good.ac", folder / "endless.smd"}, 2, 2);
        EXPECT_TRUE(queue.next());
    }
    EXPECT_LT(Clock::now() - start, soon);
}

// A program that wants to know nothing of its children loses what ended the reader, not the answer.
TEST_F(AssimpReader, WorksWhereChildrenAreIgnored) {
    const auto before = std::signal(SIGCHLD, SIG_IGN);
    EXPECT_NO_THROW(load_assimp(folder / "good.ac"));
    EXPECT_EQ(error_of("crash.ase"), expected("crash.ase", "ended without an answer"));
    std::signal(SIGCHLD, before);
}

// The first free descriptors are those that the reader has for other things.
TEST_F(AssimpReader, WorksWithoutStandardInput) {
    const int kept = ::dup(0);
    ::close(0);
    EXPECT_NO_THROW(load_assimp(folder / "good.ac"));
    if (kept >= 0) ::dup2(kept, 0), ::close(kept);
}

}  // namespace
}  // namespace easypbr::io::assimp_reader_test
