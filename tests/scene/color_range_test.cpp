#include "easypbr/scene/color_range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace easypbr::color_range_test {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A row of three numbers.
ArrayXf::Dense row(float red, float green, float blue) {
    ArrayXf::Dense C(1, 3);
    C << red, green, blue;
    return C;
}

}  // namespace

TEST(ColorRange, PassesOverWhatIsNoNumber) {
    ColorRange range = range_of_colors(row(NAN, 3, -1));
    EXPECT_EQ(range.low, -1);
    EXPECT_EQ(range.high, 3);
    range = range_of_colors(row(NAN, NAN, NAN));
    EXPECT_EQ(range.low, 0);
    EXPECT_EQ(range.high, 0);
    EXPECT_EQ(range_of_colors(row(0, infinity, 0)).high, infinity);
    EXPECT_EQ(range_of_colors(ArrayXf::Dense(0, 3)).high, 0);
}

TEST(ColorRange, IsFoundInLongArrays) {
    ArrayXf::Dense C = ArrayXf::Dense::Constant(100'000, 3, 0.5f);
    C(99'999, 2) = 0.75f;
    C(50'000, 1) = 0.25f;
    EXPECT_EQ(range_of_colors(C).low, 0.25f);
    EXPECT_EQ(range_of_colors(C).high, 0.75f);
}

TEST(ColorRange, TellsWhatFullIntensityIs) {
    for (const float high : {0.0f, 0.5f, 1.0f, 1.5f}) EXPECT_EQ(white_of({0, high}), 1) << high;
    for (const float high : {2.0f, 254.5f, 255.0f}) EXPECT_EQ(white_of({0, high}), 255) << high;
    for (const float high : {256.0f, 65535.0f}) EXPECT_EQ(white_of({0, high}), 65535) << high;
    ArrayXf::Dense C = row(255, 51, 0);
    normalize_colors(C);
    EXPECT_TRUE(C.isApprox(row(1, 0.2f, 0), 1e-6f));
    normalize_colors(C);
    EXPECT_TRUE(C.isApprox(row(1, 0.2f, 0), 1e-6f));
}

TEST(ColorRange, InfiniteNumbersDoNotDarkenTheOthers) {
    ArrayXf::Dense C = row(infinity, 0.5f, -infinity);
    normalize_colors(C);
    EXPECT_EQ(C, row(infinity, 0.5f, -infinity));
    C = row(infinity, 51, 255);
    normalize_colors(C);
    EXPECT_EQ(C, row(infinity, 0.2f, 1));
}

}  // namespace easypbr::color_range_test
