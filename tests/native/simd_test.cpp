// GLSL's functions on lanes, against those of the standard library.
#define EASYPBR_ISA checked

#include "easypbr/native/simd/samplers.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <functional>
#include <vector>

namespace easypbr::native::checked {
namespace {

using Function = vfloat (*)(vfloat);
using Reference = double (*)(double);

/// Largest error of `function` on [from, to], absolute, or relative to values beyond 1.
double error_of(Function function, Reference reference, double from, double to) {
    double worst = 0;
    constexpr int steps = 100000;
    for (int i = 0; i <= steps; ++i) {
        const auto x = float(from + (to - from) * i / steps);
        const double value = double(function(vfloat(x)).v[0]), expected = reference(double(x));
        worst = std::max(worst, std::abs(value - expected) / std::max(1.0, std::abs(expected)));
    }
    return worst;
}

// The bounds are those that lanes.h states.
TEST(Lanes, ExponentialAndLogarithm) {
    EXPECT_LT(error_of(exp2, std::exp2, -20, 20), 4e-7);
    EXPECT_LT(error_of(log2, std::log2, 1e-6, 1e-3), 1e-6);
    EXPECT_LT(error_of(log2, std::log2, 1e-3, 100), 1e-6);
}

TEST(Lanes, Angles) {
    EXPECT_LT(error_of(acos, std::acos, -1, 1), 1e-6);
    EXPECT_LT(error_of(sin, std::sin, -100, 100), 1e-5);
    EXPECT_LT(error_of(cos, std::cos, -100, 100), 1e-5);
    for (double angle = -3.14; angle < 3.14; angle += 0.001) {
        const auto y = float(std::sin(angle)), x = float(std::cos(angle));
        EXPECT_NEAR(double(atan(vfloat(y), vfloat(x)).v[0]), std::atan2(double(y), double(x)), 1e-5);
    }
}

TEST(Lanes, Roots) {
    EXPECT_EQ(error_of(
                  sqrt, [](double x) { return double(std::sqrt(float(x))); }, 0, 1000),
              0);
    EXPECT_LT(error_of(
                  inversesqrt, [](double x) { return 1 / std::sqrt(x); }, 0.01, 1000),
              2e-7);
    EXPECT_EQ(error_of(floor, std::floor, -1000, 1000), 0);
}

TEST(Lanes, PowerOfZeroIsZero) {
    EXPECT_EQ(pow(vfloat(0.0f), vfloat(2.4f)).v[0], 0.0f);
    EXPECT_NEAR(pow(vfloat(0.5f), vfloat(2.4f)).v[0], std::pow(0.5, 2.4), 1e-6);
}

TEST(Lanes, CountsBits) {
    for (const unsigned bits : {0u, 1u, 0xffffffffu, 0x80000000u, 0x12345678u})
        EXPECT_EQ(bitCount(vuint(bits)).v[0], std::popcount(bits));
}

TEST(Lanes, ChoosesByLane) {
    const vfloat numbers = to_float(lane_numbers());
    const vfloat chosen = select(numbers < 2.0f, numbers, vfloat(-1.0f));
    for (int k = 0; k < lanes; ++k) EXPECT_EQ(chosen.v[k], k < 2 ? float(k) : -1.0f);
    EXPECT_TRUE(any_lane(numbers == 3.0f));
    EXPECT_FALSE(any_lane(numbers == 99.0f));
}

TEST(Samplers, HalvesAreExact) {
    for (int bits = 0; bits < 0x7c00; ++bits) {
        const auto h = uint16_t(bits);
        const float expected = float(Eigen::half(Eigen::half_impl::raw_uint16_to_half(h)));
        EXPECT_EQ(from_halves(Shorts4{h, h, h, h})[1], expected);
        EXPECT_EQ(from_halves(Shorts8{h, h, h, h, h, h, h, h})[6], expected);
    }
}

class Pictures : public testing::Test {
  protected:
    static constexpr int width = 5, height = 4;

    Pictures() {
        for (size_t i = 0; i < values_.size(); ++i) values_[i] = float(i + 1);
    }
    R32f view() const {
        R32f view;
        static_cast<View&>(view) = View{.data = reinterpret_cast<const std::byte*>(values_.data()),
                                        .width = width + 3,
                                        .height = height + 2,
                                        .x = 2,
                                        .y = 1,
                                        .held_width = width,
                                        .held_height = height};
        return view;
    }
    float expected(int x, int y) const {
        x = std::clamp(x, 0, width + 2) - 2;
        y = std::clamp(y, 0, height + 1) - 1;
        const bool inside = x >= 0 && x < width && y >= 0 && y < height;
        return inside ? values_[size_t(y * width + x)] : 0.0f;
    }
    std::vector<float> values_ = std::vector<float>(size_t(width * height));
};

// Beside the picture its border counts, within it what is not held is zero.
TEST_F(Pictures, FetchesAnywhere) {
    for (int y = -2; y < height + 5; ++y)
        for (int x = -3; x < width + 6; ++x)
            for (int step = 0; step < 3; ++step) {
                const vec4 found = fetch(view(), lane_numbers() * step + x, vint(y));
                for (int k = 0; k < lanes; ++k)
                    EXPECT_EQ(found.x.v[k], expected(x + k * step, y)) << x << ' ' << y;
            }
}

TEST_F(Pictures, FacesOfCubesAreOpenGLs) {
    const struct {
        vec3 direction;
        int face;
    } cases[] = {{{1.0f, 0.2f, -0.3f}, 0}, {{-1.0f, 0.2f, 0.3f}, 1}, {{0.1f, 1.0f, 0.2f}, 2},
                 {{0.1f, -1.0f, 0.2f}, 3}, {{0.1f, 0.2f, 1.0f}, 4},  {{0.1f, 0.2f, -1.0f}, 5}};
    for (const auto& c : cases) EXPECT_EQ(cube_place(c.direction).face.v[0], c.face);
    // Table 8.19: s of +x is -z, t is -y.
    const CubePlace place = cube_place({2.0f, 1.0f, -0.5f});
    EXPECT_FLOAT_EQ(place.s.v[0], 0.5f * (0.25f + 1));
    EXPECT_FLOAT_EQ(place.t.v[0], 0.5f * (-0.5f + 1));
}

}  // namespace
}  // namespace easypbr::native::checked
