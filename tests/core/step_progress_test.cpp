#include "easypbr/core/step_progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "easypbr/core/log.h"

namespace easypbr::step_progress_test {
namespace {

struct Said {
    std::vector<std::string> texts;
    std::vector<double> parts;

    Said() {
        set_progress_sink([this](std::string_view what, double part) {
            texts.emplace_back(what);
            parts.push_back(part);
        });
    }
    ~Said() { set_progress_sink({}); }
    Said(const Said&) = delete;
    Said& operator=(const Said&) = delete;
};

void wait_ms(int ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

TEST(StepProgress, IsSilentForWhatIsQuick) {
    Said said;
    {
        StepProgress progress("picture", "sample", 3);
        for (int i = 1; i <= 3; ++i) progress.done(i);
    }
    EXPECT_TRUE(said.texts.empty());
}

TEST(StepProgress, SaysHowFarItIsAndThatItEnded) {
    Said said;
    {
        StepProgress progress("picture", "sample", 4, 0.02);
        wait_ms(30);
        progress.done(1);
        progress.done(2);  // Sooner than a person can read it.
    }
    ASSERT_EQ(said.texts.size(), 2u);
    EXPECT_TRUE(std::regex_match(said.texts[0], std::regex("picture: sample 1 of 4, 0:0[0-9] left")))
        << said.texts[0];
    EXPECT_EQ(said.texts[1], "picture");
    EXPECT_EQ(said.parts, (std::vector<double>{0.25, 1}));
}

TEST(StepProgress, IsAPartOfTheStepAroundIt) {
    Said said;
    {
        StepProgress frames("turn.mp4", "frame", 2, 0);
        frames.done(1);
        wait_ms(210);
        StepProgress samples("picture", "sample", 4, 0);
        samples.done(2);
    }
    ASSERT_EQ(said.texts.size(), 3u);
    EXPECT_TRUE(said.texts[1].starts_with("turn.mp4: frame 2 of 2")) << said.texts[1];
    EXPECT_EQ(said.parts, (std::vector<double>{0.5, 0.75, 1}));
    EXPECT_EQ(said.texts[2], "turn.mp4");
}

struct Cancelled {};

// What the sink throws reaches the caller; the end is not reported, as it was not reached.
TEST(StepProgress, PassesOnWhatTheSinkThrows) {
    int calls = 0;
    set_progress_sink([&](std::string_view, double) {
        ++calls;
        throw Cancelled();
    });
    const auto work = [] {
        StepProgress frames("turn.mp4", "frame", 2, 0);
        StepProgress samples("picture", "sample", 4, 0);
        wait_ms(1);
        samples.done(1);
    };
    EXPECT_THROW(work(), Cancelled);
    EXPECT_EQ(calls, 1);
    set_progress_sink({});
}

// The work is done then: there is nothing to give up.
TEST(StepProgress, EndsWithASinkThatThrowsAtTheEnd) {
    std::vector<double> parts;
    set_progress_sink([&](std::string_view, double part) {
        parts.push_back(part);
        if (part >= 1) throw Cancelled();
    });
    {
        StepProgress progress("picture", "sample", 4, 0);
        wait_ms(1);
        progress.done(2);
    }
    set_progress_sink({});
    EXPECT_EQ(parts, (std::vector<double>{0.5, 1}));
}

// A destructor may do work of its own while an exception passes: that work does end.
TEST(StepProgress, EndsWithinADestructorThatAnExceptionCalls) {
    Said said;
    struct Work {
        ~Work() {
            StepProgress progress("picture", "sample", 4, 0);
            wait_ms(1);
            progress.done(2);
        }
    };
    try {
        const Work work;
        throw Cancelled();
    } catch (const Cancelled&) {
    }
    EXPECT_EQ(said.parts, (std::vector<double>{0.5, 1}));
}

}  // namespace
}  // namespace easypbr::step_progress_test
