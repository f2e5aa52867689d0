#include "easypbr/scene/label_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

namespace easypbr::label_colors_test {

namespace {

double smallest_distance(const GeneratedColors& colors, int32_t count) {
    double smallest = std::numeric_limits<double>::infinity();
    for (int32_t i = 0; i < count; ++i)
        for (int32_t k = 0; k < i; ++k)
            smallest = std::min(
                smallest, (oklab_from_rgb8(colors.color_of(i)) - oklab_from_rgb8(colors.color_of(k))).norm());
    return smallest;
}

}  // namespace

// Ottosson's post gives these: white is (1, 0, 0), and the sRGB primary red (0.628, 0.225, 0.126).
TEST(LabelColors, OklabIsThatOfItsAuthor) {
    EXPECT_LT((oklab_from_rgb8({255, 255, 255}) - Vec3d(1, 0, 0)).norm(), 1e-3);
    EXPECT_LT((oklab_from_rgb8({255, 0, 0}) - Vec3d(0.628, 0.225, 0.126)).norm(), 1e-3);
    EXPECT_EQ(oklab_from_rgb8({0, 0, 0}).norm(), 0);
}

// The distances are those that an independent greedy choice in numpy finds over the same colours (0.146,
// 0.115, 0.0828, 0.0480), less 1 %. A just noticeable difference in OKLab is about 0.02.
TEST(LabelColors, AreWellSeparated) {
    const GeneratedColors colors(255);
    EXPECT_GT(smallest_distance(colors, 16), 0.145);
    EXPECT_GT(smallest_distance(colors, 32), 0.114);
    EXPECT_GT(smallest_distance(colors, 64), 0.0820);
    EXPECT_GT(smallest_distance(colors, 256), 0.0475);
}

TEST(LabelColors, DependOnTheirNumberAlone) {
    const GeneratedColors few(3), many(999);
    EXPECT_EQ(few.color_of(0), (Rgb8{255, 138, 255}));
    EXPECT_EQ(few.color_of(1), (Rgb8{156, 210, 21}));
    for (int32_t label = 0; label < 4; ++label) EXPECT_EQ(few.color_of(label), many.color_of(label));
}

TEST(LabelColors, StandOutFromBackgrounds) {
    const GeneratedColors colors(63);
    for (const uint8_t grey : {0, 64, 255})
        for (int32_t label = 0; label < 64; ++label)
            EXPECT_GT((oklab_from_rgb8(colors.color_of(label)) - oklab_from_rgb8({grey, grey, grey})).norm(),
                      0.08);
}

TEST(LabelColors, AreAsManyAsTheySay) {
    const GeneratedColors colors(std::numeric_limits<int32_t>::max());
    std::set<Rgb8> different;
    for (int32_t label = 0; label < generated_color_count; ++label) different.insert(colors.color_of(label));
    EXPECT_EQ(int(different.size()), generated_color_count);
    EXPECT_EQ(colors.color_of(generated_color_count + 5), colors.color_of(5));
    EXPECT_EQ(colors.color_of(-1), (Rgb8{128, 128, 128}));
    EXPECT_EQ(colors.color_of(std::numeric_limits<int32_t>::min()), (Rgb8{128, 128, 128}));
}

}  // namespace easypbr::label_colors_test
