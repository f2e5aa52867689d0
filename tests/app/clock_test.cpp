#include "easypbr/app/clock.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr::app::clock_test {
namespace {

TEST(Clock, FixedStepsAreCountedNotAddedUp) {
    Clock clock;
    EXPECT_EQ(clock.time(), 0);
    clock.set_fixed_step(0.1);
    clock.tick();
    EXPECT_EQ(clock.time(), 0) << "the first frame";
    EXPECT_EQ(clock.delta_time(), 0);
    for (int i = 0; i < 100000; ++i) clock.tick();
    EXPECT_EQ(clock.time(), 0.1 * 100000);
    EXPECT_EQ(clock.delta_time(), 0.1);
    clock.set_fixed_step(0.25);
    clock.tick();
    EXPECT_EQ(clock.time(), 0.1 * 100000 + 0.25);
}

TEST(Clock, RealTimePassesBetweenFrames) {
    Clock clock;
    clock.tick();
    EXPECT_EQ(clock.delta_time(), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(clock.time(), 0) << "the time of a frame stands still";
    clock.tick();
    EXPECT_GE(clock.delta_time(), 0.02);
    EXPECT_EQ(clock.time(), clock.delta_time());
}

TEST(Clock, MayBeSet) {
    Clock clock;
    clock.set_fixed_step(0.5);
    clock.tick();
    clock.set_time(10);
    clock.tick();
    EXPECT_EQ(clock.time(), 10) << "the first frame is at the time that was set";
    EXPECT_EQ(clock.delta_time(), 0);
    clock.tick();
    EXPECT_EQ(clock.time(), 10.5);
    clock.set_fixed_step({});
    EXPECT_EQ(clock.time(), 10.5) << "time goes on from where it is";
    clock.tick();
    EXPECT_EQ(clock.time(), 10.5) << "the first frame in real time";
    clock.set_fixed_step(0.5);
    clock.tick();
    EXPECT_EQ(clock.time(), 10.5) << "the first frame of the steps";
    clock.set_fixed_step(0.25);
    clock.tick();
    EXPECT_EQ(clock.time(), 10.75) << "another step goes on";
    EXPECT_THROW(clock.set_fixed_step(0), ArgumentError);
    EXPECT_THROW(clock.set_time(std::numeric_limits<double>::infinity()), ArgumentError);
}

TEST(Clock, EndsTheFrameThatWasDrawnFirst) {
    Clock clock;
    clock.set_fixed_step(0.5);
    clock.end_frame();
    EXPECT_EQ(clock.time(), 0.5);
    EXPECT_EQ(clock.delta_time(), 0.5);
    clock.end_frame();
    EXPECT_EQ(clock.time(), 1);
    clock.set_time(0);
    clock.end_frame();
    EXPECT_EQ(clock.time(), 0.5) << "that of 0 was drawn";
}

TEST(Clock, TakesBackAFrame) {
    Clock clock;
    clock.set_fixed_step(0.5);
    std::vector<double> times;
    clock.on_tick = [&] { times.push_back(clock.time()); };
    clock.tick();
    clock.take_back();
    clock.tick();
    clock.tick();
    EXPECT_EQ(clock.time(), 0.5);
    clock.take_back();
    EXPECT_EQ(clock.time(), 0);
    EXPECT_EQ(clock.delta_time(), 0);
    EXPECT_EQ(times, (std::vector<double>{0, 0, 0, 0.5, 0}));
    clock.set_time(3);
    clock.take_back();
    EXPECT_EQ(clock.time(), 3) << "no frame has begun since";
}

}  // namespace
}  // namespace easypbr::app::clock_test
