#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/scene/animation.h"
#include "refusal.h"
#include "scene/animation_channels.h"

namespace easypbr::animation_channel_test {
namespace {

TEST(AnimationChannel, LinearAndStep) {
    const ArrayXf::Dense values{{0, 0, 0}, {2, 4, 8}, {2, 0, 0}};
    const AnimationChannel linear = channel(Interpolation::linear, {1, 3, 4}, values),
                           step = channel(Interpolation::step, {1, 3, 4}, values);
    EXPECT_EQ(sample(linear, 1.5), Vec3d(0.5, 1, 2));
    EXPECT_EQ(sample(linear, 3.75), Vec3d(2, 1, 2));
    EXPECT_EQ(sample(step, 2.999), Vec3d(0, 0, 0));
    EXPECT_EQ(sample(step, 3), Vec3d(2, 4, 8));
    for (const AnimationChannel& c : {linear, step}) {
        EXPECT_EQ(sample(c, -5), Vec3d(0, 0, 0));
        EXPECT_EQ(sample(c, 99), Vec3d(2, 0, 0));
    }
}

// Hermite's cubic with the values 0 and 1 and the tangents a and b over a time of 2 is, at a quarter,
// 3/16 - 2/64 + 2 a (1/64 - 2/16 + 1/4) + 2 b (1/64 - 1/16).
TEST(AnimationChannel, CubicSpline) {
    const float a = 3, b = -5;
    const AnimationChannel cubic =
        channel(Interpolation::cubic_spline, {0, 2},
                ArrayXf::Dense{{9, 9, 9}, {0, 0, 0}, {a, 0, 0}, {b, 0, 0}, {1, 0, 0}, {9, 9, 9}});
    const double expected =
        3.0 / 16 - 2.0 / 64 + 2 * 3 * (1.0 / 64 - 2.0 / 16 + 1.0 / 4) - 2 * 5 * (1.0 / 64 - 1.0 / 16);
    EXPECT_NEAR(sample(cubic, 0.5)[0], expected, 1e-15);
    EXPECT_EQ(sample(cubic, 0), Vec3d(0, 0, 0));
    EXPECT_EQ(sample(cubic, 2), Vec3d(1, 0, 0));
}

// From 0 to 270 degrees about y is -90 the shorter way; a third of the time is -30 degrees.
TEST(AnimationChannel, RotationsGoTheShorterWay) {
    const float half = float(std::sqrt(0.5));
    const AnimationChannel turn =
        channel(Interpolation::linear, {0, 3}, ArrayXf::Dense{{0, 0, 0, 1}, {0, half, 0, -half}},
                AnimatedProperty::rotation);
    const Eigen::VectorXd q = sample(turn, 1);
    EXPECT_NEAR(std::abs(q[3]), std::cos(radians(15)), 1e-7);
    EXPECT_NEAR(q[1] * q[3], -std::sin(radians(15)) * std::cos(radians(15)), 1e-7);
    EXPECT_NEAR(q.norm(), 1, 1e-15);
}

TEST(AnimationChannel, WithoutKeysThatFitIsNotSampled) {
    const auto message = [](const AnimationChannel& c) { return refusal([&] { sample(c, 0.5); }); };
    EXPECT_EQ(message({}), "animation channel: expected times, got none");
    EXPECT_EQ(
        message(channel(Interpolation::linear, {0, 1}, ArrayXf::Dense::Zero(1, 3))),
        "animation channel: expected values of 2 rows, 1 for each of 2 times, and 3 columns, got 1 x 3");
    EXPECT_EQ(
        message(channel(Interpolation::cubic_spline, {0, 1}, ArrayXf::Dense::Zero(2, 3))),
        "animation channel: expected values of 6 rows, 3 for each of 2 times, and 3 columns, got 2 x 3");
    EXPECT_NE(message(channel(Interpolation::linear, {0, 1}, ArrayXf::Dense::Zero(2, 3),
                              AnimatedProperty::rotation)),
              "taken");
    EXPECT_NE(
        message(channel(Interpolation::linear, {0, 1}, ArrayXf::Dense(2, 0), AnimatedProperty::weights)),
        "taken");
    const AnimationChannel good = channel(Interpolation::linear, {0, 1}, ArrayXf::Dense::Zero(2, 3));
    EXPECT_EQ(message(good), "taken");
    EXPECT_THROW(sample(good, std::numeric_limits<double>::quiet_NaN()), ArgumentError);
}

}  // namespace
}  // namespace easypbr::animation_channel_test
