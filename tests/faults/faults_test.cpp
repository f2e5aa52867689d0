// Every job under every fault: it is done as ever, or ends in an exception that says why; nothing
// half-written and no open file is left behind, and the next one is done as if nothing had happened.
// EASYPBR_FAULTS says how many calls fail in each job, by default a few; "all" is all.
#include "faults/faults.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <new>
#include <set>

#include "easypbr/app/frame_queue.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/video/video.h"
#include "faults/jobs.h"
#include "io/temporary_folder.h"

namespace easypbr::faults::faults_test {
namespace {

long most_faults() {
    const char* given = std::getenv("EASYPBR_FAULTS");
    if (!given) return 12;
    return std::string(given) == "all" ? 1'000'000 : std::max(1L, std::atol(given));
}

/// Numbers of calls from the first to the last, close together in the beginning.
std::set<long> chosen(long calls) {
    std::set<long> numbers;
    const long most = std::min(calls, most_faults());
    for (long i = 0; i < most; ++i)
        numbers.insert(calls <= most ? i + 1
                                     : std::lround(std::pow(double(calls), double(i) / double(most - 1))));
    return numbers;
}

size_t open_files() {
    return size_t(std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
}

/// A job in a folder of its own.
class Trial {
  public:
    explicit Trial(const Job& job) : job_(job) {
        Fault::name(job.name);
        wanted_ = run();  // what is made once is made
        written_ = names_in(folder_.path());
        files_ = open_files();
    }

    /// Calls of the kind that the job makes.
    long count(Kind kind) {
        clear();
        const Fault fault(kind);
        run();
        return Fault::calls();
    }

    /// With the fault: as ever, or an exception. Then again, without.
    void strike(Kind kind, long n) {
        SCOPED_TRACE(job_.name + ", call " + std::to_string(n));
        clear();
        std::string result, error;
        try {
            const Fault fault(kind, n);
            result = run();
        } catch (const Error& failure) {
            error = failure.what();
        } catch (const std::bad_alloc&) {
            error = "out of memory";
        } catch (const std::exception& other) {
            ADD_FAILURE() << "neither an easypbr::Error nor std::bad_alloc: " << other.what();
        }
        if (error.empty())
            EXPECT_TRUE(result == wanted_) << "another result, and no error";
        else
            EXPECT_GT(error.size(), 8u) << error;
        for (const std::string& name : names_in(folder_.path()))
            EXPECT_TRUE(written_.contains(name)) << name << " is left behind";
        EXPECT_EQ(open_files(), files_);
        const std::set<std::string> names = names_in(folder_.path());
        EXPECT_TRUE(names.empty() || names == written_) << "some of its files are there, others not";
        clear();
        EXPECT_TRUE(run() == wanted_) << "another result afterwards";
    }

    /// With a fault that nobody may notice.
    void bear(Kind kind) {
        SCOPED_TRACE(job_.name);
        clear();
        const Fault fault(kind);
        EXPECT_EQ(run(), wanted_);
    }

    /// What was there before stays, whole, when writing fails.
    void keep(Kind kind, long n) {
        SCOPED_TRACE(job_.name + ", call " + std::to_string(n));
        clear();
        for (const std::string& name : written_) std::ofstream(folder_ / name) << "old";
        try {
            const Fault fault(kind, n);
            run();
            return;
        } catch (const Error&) {
        }
        for (const std::string& name : names_in(folder_.path())) EXPECT_TRUE(written_.contains(name)) << name;
        std::set<std::string> contents;
        for (const std::string& name : written_) {
            std::ifstream file(folder_ / name);
            contents.insert(std::string(std::istreambuf_iterator<char>(file), {}).substr(0, 4));
        }
        EXPECT_TRUE(contents.size() == 1 && contents.contains("old")) << "changed by half";
    }

  private:
    std::string run() { return job_.run(folder_.path()); }
    void clear() {
        for (const auto& entry : fs::directory_iterator(folder_.path())) fs::remove_all(entry.path());
    }

    const Job& job_;
    TemporaryFolder folder_;
    std::string wanted_;
    std::set<std::string> written_;
    size_t files_ = 0;
};

class Faults : public testing::Test {
  protected:
    void SetUp() override {
        set_log_sink([](LogLevel, std::string_view) {});
    }
    void TearDown() override { set_log_sink({}); }

    static void strike(const std::vector<Job>& jobs, Kind kind) {
        long struck = 0;
        for (const Job& job : jobs) {
            Trial trial(job);
            Kind struck_kind = kind;
            if (kind == Kind::allocation && job.memory == Memory::none_may_fail) continue;
            if (kind == Kind::allocation && job.memory == Memory::large_may_fail)
                struck_kind = Kind::large_allocation;
            for (const long n : chosen(trial.count(struck_kind))) {
                trial.strike(struck_kind, n);
                ++struck;
            }
        }
        EXPECT_GT(struck, 0);
        std::printf("%ld faults in %zu jobs\n", struck, jobs.size());
    }
    static void bear(const std::vector<Job>& jobs, Kind kind) {
        for (const Job& job : jobs) Trial(job).bear(kind);
    }
};

TEST_F(Faults, NoMemoryWhileReading) {
    strike(reading_jobs(), Kind::allocation);
}

TEST_F(Faults, NoMemoryWhileWriting) {
    strike(writing_jobs(), Kind::allocation);
}

TEST_F(Faults, NoMemoryWhileComputing) {
    strike(computing_jobs(), Kind::allocation);
}

TEST_F(Faults, ShortReadsAndWrites) {
    bear(reading_jobs(), Kind::short_reads);
    bear(writing_jobs(), Kind::short_reads);
}

TEST_F(Faults, Interruptions) {
    bear(reading_jobs(), Kind::interruptions);
    bear(writing_jobs(), Kind::interruptions);
}

TEST_F(Faults, FilesThatCannotBeOpened) {
    strike(reading_jobs(), Kind::open);
    strike(writing_jobs(), Kind::open);
}

TEST_F(Faults, ADiskThatCannotBeRead) {
    strike(reading_jobs(), Kind::read);
}

TEST_F(Faults, AFullDisk) {
    strike(writing_jobs(), Kind::write);
    for (const Job& job : writing_jobs()) {
        Trial trial(job);
        for (const long n : chosen(trial.count(Kind::write))) trial.keep(Kind::write, n);
    }
}

TEST_F(Faults, AFolderThatTakesNoFiles) {
    strike(writing_jobs(), Kind::rename);
    for (const Job& job : writing_jobs()) Trial(job).keep(Kind::rename, 1);
}

/// Counts the pictures that it gets, on up to four threads.
class CountingWriter : public app::FrameWriter {
  public:
    explicit CountingWriter(std::atomic<int>& count) : count_(count) {}
    void write(int, const Image&) override { ++count_; }
    int threads() const override { return 4; }

  private:
    std::atomic<int>& count_;
};

TEST_F(Faults, NoThreads) {
    std::atomic<int> count = 0;
    try {
        const Fault fault(Kind::thread, 1);
        app::FrameQueue queue(std::make_unique<CountingWriter>(count));
        ADD_FAILURE() << "there is no thread";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("cannot start a thread"), std::string::npos) << error.what();
    }
    // The second one fails: the first does all.
    const Fault fault(Kind::thread, 2);
    app::FrameQueue queue(std::make_unique<CountingWriter>(count));
    EXPECT_TRUE(Fault::happened());
    for (int i = 0; i < 10; ++i) queue.push(Image(2, 2, 4, PixelType::u8));
    queue.finish();
    EXPECT_EQ(count, 10);
}

TEST_F(Faults, AnEncoderWithoutThreads) {
    if (io::video_support() != "written by FFmpeg's libraries") GTEST_SKIP() << io::video_support();
    const TemporaryFolder folder;
    const Fault fault(Kind::thread, 1);
    const auto video = io::open_video(folder / "a.mp4", {.size = {64, 48}, .fps = 25, .codec = {}});
    for (int i = 0; i < 3; ++i) video->add(Image(64, 48, 4, PixelType::u8));
    video->finish();
    EXPECT_GT(fs::file_size(folder / "a.mp4"), 0u);
}

TEST_F(Faults, AClockThatJumps) {
    bear(reading_jobs(), Kind::clock);
    bear(writing_jobs(), Kind::clock);
    bear(computing_jobs(), Kind::clock);
}

}  // namespace
}  // namespace easypbr::faults::faults_test
