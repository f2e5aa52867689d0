// How many frames a picture has time for, by a clock that the tests turn.
#include "easypbr/render/pipeline/frame_times.h"

#include <gtest/gtest.h>

namespace easypbr::frame_times_test {
namespace {

/// How many frames are drawn of which the first takes `first` seconds and the others `later` each.
int frames_in(double budget, double first, double later) {
    render::FrameTimes times;
    while (times.has_time(budget)) times.add(times.frames == 0 ? first : later);
    return times.frames;
}

// 1.25 s are left after the first frame: 5 of 0.25 s.
TEST(FrameTimes, TheFirstFrameIsNotTheLengthOfOthers) {
    EXPECT_EQ(frames_in(2, 0.75, 0.25), 6);
    EXPECT_EQ(frames_in(2, 1.5, 0.25), 3);
}

TEST(FrameTimes, TheFirstFrameIsAlwaysDrawn) {
    EXPECT_EQ(frames_in(1e-6, 1, 1), 1);
    EXPECT_EQ(frames_in(1, 1, 1), 1);
}

// Nothing tells how long it takes, but there is time.
TEST(FrameTimes, TheSecondFrameIsTriedWhileThereIsTime) {
    EXPECT_EQ(frames_in(1, 0.75, 8), 2);
}

// Powers of two are exact.
TEST(FrameTimes, EqualFramesFillTheTime) {
    EXPECT_EQ(frames_in(1, 0.125, 0.125), 8);
    EXPECT_EQ(frames_in(1.0625, 0.125, 0.125), 8);
}

}  // namespace
}  // namespace easypbr::frame_times_test
