// Where the ticks of a logarithmic colour bar stand, and how bars and legends get into narrow pictures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/app/annotation.h"
#include "easypbr/app/font.h"
#include "easypbr/app/scene_warnings.h"
#include "easypbr/core/log.h"

namespace easypbr::app::colorbar_layout_test {
namespace {

using Texts = std::vector<std::string>;

Texts log_texts(float min, float max, int most) {
    Texts all;
    for (const Tick& tick : ticks_of(ValueRange{min, max, min, max, ColorScale::log}, most))
        all.push_back(tick.text);
    return all;
}

const Rgb8 red{200, 0, 0};

ColorBar red_bar(const std::string& title = "t") {
    ColorBar bar;
    bar.title = title;
    bar.range = {0, 1, 0, 1};
    bar.table.fill(opaque(red));
    return bar;
}

/// What is drawn into a grey picture.
struct Drawn {
    PixelRect touched;  ///< all that changed; no width: nothing did
    int red_columns = 0;
};
Drawn drawn(const Annotation& annotation, Vec2i size,
            const BasicAnnotationSettings<Inferred>& settings = {}) {
    Image before(size.x(), size.y(), 4, PixelType::u8);
    Canvas(before).fill({0, 0, size.x(), size.y()}, {64, 64, 64});
    Image after = before;
    draw_annotation(annotation, settings, after);
    int left = size.x(), top = size.y(), right = -1, bottom = -1;
    Drawn result;
    for (int x = 0; x < size.x(); ++x) {
        bool has_red = false;
        for (int y = 0; y < size.y(); ++y) {
            const uint8_t *p = after.at<uint8_t>(x, y), *q = before.at<uint8_t>(x, y);
            has_red |= Rgb8{p[0], p[1], p[2]} == red;
            if (std::equal(p, p + 4, q)) continue;
            left = std::min(left, x), right = std::max(right, x);
            top = std::min(top, y), bottom = std::max(bottom, y);
        }
        result.red_columns += has_red;
    }
    result.touched = {left, top, std::max(0, right - left + 1), std::max(0, bottom - top + 1)};
    return result;
}

}  // namespace

TEST(LogTicks, AreOneTwoAndFiveTimesPowersOfTen) {
    EXPECT_EQ(log_texts(1.01f, 99, 5), (Texts{"2", "5", "10", "20", "50"}));
    EXPECT_EQ(log_texts(0.11f, 9.9f, 5), (Texts{"0.2", "0.5", "1", "2", "5"}));
    EXPECT_EQ(log_texts(1.5f, 95, 6), (Texts{"2", "5", "10", "20", "50"}));
    // The ends as float32 holds them.
    EXPECT_EQ(log_texts(0.1f, 1, 4), (Texts{"0.1", "0.2", "0.5", "1"}));
    EXPECT_EQ(log_texts(2e-8f, 1e-7f, 4), (Texts{"2e-8", "5e-8", "1e-7"}));
}

// Each second or third of them, the last one always, or every n-th power of ten.
TEST(LogTicks, AreThinnedWhereThereIsNoRoom) {
    EXPECT_EQ(log_texts(1.01f, 99, 4), (Texts{"2", "10", "50"}));
    EXPECT_EQ(log_texts(1.01f, 99, 2), (Texts{"5", "50"}));
    EXPECT_EQ(log_texts(0.9f, 110, 3), (Texts{"1", "10", "100"}));
    EXPECT_EQ(log_texts(1, 1e6f, 4), (Texts{"1e0", "1e2", "1e4", "1e6"}));
}

TEST(LogTicks, AreThoseOfALinearScaleWithinPartOfADecade) {
    EXPECT_EQ(log_texts(1.2f, 1.9f, 4), (Texts{"1.2", "1.4", "1.6", "1.8"}));
    EXPECT_EQ(log_texts(2.5f, 4.5f, 4), (Texts{"3", "4"}));
}

TEST(LogTicks, AreTwoAtLeastWhereThereIsRoom) {
    // Only 1.05 and 1.5 are multiples of 0.05 and 0.5: the outermost of 0.02 and of 0.2.
    for (const int most : {2, 3}) {
        EXPECT_EQ(log_texts(1.01f, 1.09f, most), (Texts{"1.02", "1.08"}));
        EXPECT_EQ(log_texts(1.2f, 1.9f, most), (Texts{"1.2", "1.8"}));
    }
    // 200 alone is 1, 2 or 5 times a power of ten.
    EXPECT_EQ(log_texts(105.2f, 389.3f, 2), (Texts{"200", "300"}));
    EXPECT_EQ(log_texts(1.01f, 1.09f, 1), (Texts{"1.05"}));
}

// A bar holds two rows of text for each of the `most` ticks; texts on less than 0.6 rows of their own touch.
TEST(LogTicks, DoNotTouch) {
    for (const float min : {0.003f, 0.7f, 1.0f, 1.01f, 4.0f, 8.9f})
        for (const float decades : {0.05f, 0.3f, 0.6f, 0.99f, 1.2f, 1.99f, 2.5f, 7.0f})
            for (const int most : {2, 3, 5, 8}) {
                const float max = min * std::pow(10.0f, decades);
                const ValueRange range{min, max, min, max, ColorScale::log};
                const std::vector<Tick> ticks = ticks_of(range, most);
                EXPECT_GE(ticks.size(), 2u) << min << " " << max;
                EXPECT_LE(int(ticks.size()), most) << min << " " << max;
                for (size_t i = 1; i < ticks.size(); ++i)
                    EXPECT_GE(
                        (place_on_scale(ticks[i].value, range) - place_on_scale(ticks[i - 1].value, range)) *
                            2 * most,
                        0.6)
                        << min << " to " << max << ", " << most;
            }
}

// A bar is 1.1 text sizes wide: 13 pixels of small text (11.4) and of text of 0.03 times 400 pixels. Beside
// it stand a border of 0.8, padding of 0.6 twice, ticks, "0.0" and a gap: 6 sizes, more than a third of 150
// pixels. The panel's 19 sizes are less than a third of the height.
TEST(ColorBarRoom, NarrowPicturesShowTheWholeBar) {
    const Annotation bar{{}, {red_bar()}};
    for (const int width : {100, 150, 400}) {
        const Vec2i size(width, 1000);
        const Drawn found = drawn(bar, size);
        EXPECT_EQ(found.red_columns, 13) << width;
        EXPECT_GT(found.touched.x, 0);
        EXPECT_LT(found.touched.x + found.touched.width, width);
        const Insets strip = annotation_strip(bar, {}, size);
        EXPECT_EQ(strip.right > 0, width == 400);
        EXPECT_EQ(strip.top > 0, width < 400);
    }
}

// Three bars of text of 0.2 times 200 pixels are wider than the picture, those of 7 pixels are not.
TEST(ColorBarRoom, LargeTextIsSmallerBeforeABarIsLeftOut) {
    BasicAnnotationSettings<Inferred> large;
    large.text_size = 0.2f;
    const Annotation bars{{}, {red_bar("a"), red_bar("b"), red_bar("c")}};
    EXPECT_EQ(annotations_left_out(bars, large, {200, 200}), 0);
    EXPECT_GT(drawn(bars, {200, 200}, large).red_columns, 3 * 8) << "1.1 times 7 pixels";
}

// Beside each other: of text of 14.4 pixels three would take 3 * 75 + 12 pixels, more than a third of 640.
TEST(ColorBarRoom, TextIsSmallerWhereOnlyThatFitsTheStrip) {
    const Annotation bars{{}, {red_bar("a"), red_bar("b"), red_bar("c")}};
    const Insets strip = annotation_strip(bars, {}, {640, 480});
    EXPECT_GT(strip.right, 0);
    EXPECT_LE(strip.right, 1.0 / 3);
    const int columns = drawn(bars, {640, 480}).red_columns;
    EXPECT_LT(columns, 3 * 16) << "1.1 times 14.4 pixels";
    EXPECT_GE(columns, 3 * 11) << "1.1 times two thirds of that";
}

// Of a third of 640 pixels the title has what the border (12), padding (9 twice) and the gap (9) leave, but
// for less than a letter, 0.82 text sizes of 14.4 pixels.
TEST(ColorBarRoom, LongTitlesAreCutToTheStrip) {
    const Annotation bar{{}, {red_bar(std::string(51, 'w'))}};
    const Vec2i size(640, 480);
    const Insets strip = annotation_strip(bar, {}, size);
    EXPECT_GT(strip.right, 0);
    const Drawn found = drawn(bar, size);
    EXPECT_EQ(found.red_columns, 16);
    EXPECT_LE(found.touched.width, 640 / 3 - 12 - 9);
    EXPECT_GT(found.touched.width, 640 / 3 - 12 - 9 - 13);
    // Two share it.
    const Annotation two{{}, {red_bar(std::string(51, 'w')), red_bar(std::string(50, 'w'))}};
    EXPECT_GT(annotation_strip(two, {}, size).right, 0);
    EXPECT_LE(annotation_strip(two, {}, size).right, 1.0 / 3);
}

// Of the smallest text, with one tick of one digit, a bar's panel takes 25 pixels and a gap of 4, beside a
// border of 6.
TEST(ColorBarRoom, WhatDoesNotFitIsLeftOutAndToldOnce) {
    const Annotation bars{{}, {red_bar("a"), red_bar("b"), red_bar("c")}};
    EXPECT_EQ(annotations_left_out(bars, {}, {64, 48}), 1);
    EXPECT_EQ(annotations_left_out(bars, {}, {640, 480}), 0);
    EXPECT_EQ(annotations_left_out({}, {}, {1, 1}), 0);
    EXPECT_EQ(drawn(bars, {64, 48}).red_columns, 2 * 8);
    EXPECT_EQ(annotations_left_out(bars, {}, {16, 16}), 3);
    EXPECT_EQ(drawn(bars, {16, 16}).touched.width, 0);
    Texts told;
    set_log_sink([&](LogLevel, std::string_view message) { told.emplace_back(message); });
    SceneWarnings warnings;
    for (const Vec2i& size : {Vec2i(64, 48), Vec2i(64, 48), Vec2i(640, 480), Vec2i(16, 16)})
        warnings.check(bars, {}, size);
    set_log_sink({});
    EXPECT_EQ(told,
              (Texts{"annotation: an image of 64x48 pixels has no room for 1 of 3 legends and colour bars",
                     "annotation: an image of 16x16 pixels has no room for 3 of 3 legends and colour bars"}));
}

// One that has no missing values shares either bar, the first.
TEST(ColorBars, AreSharedByOneColourOfMissingValues) {
    const auto mesh_with = [](float value, const Vec3& nan_color) {
        MeshData mesh;
        mesh.V = Array3f(Array3f::Dense::Zero(3, 3));
        mesh.scalars = {{"s", Array1f(Array1f::Dense{{0.0f}, {1.0f}, {value}})}};
        mesh.style.nan_color = nan_color;
        return std::make_shared<const MeshData>(mesh);
    };
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    SceneSnapshot scene;
    const auto add = [&](const char* name, float value, const Vec3& nan_color) {
        scene.objects.push_back({name, mesh_with(value, nan_color), Eigen::Affine3d::Identity()});
    };
    add("a", none, Vec3(1, 0, 0));
    add("b", none, Vec3(0, 0, 1));
    add("c", 0.5f, Vec3(0, 1, 0));
    InferredSettings settings;
    settings.camera.up = "+y";
    settings.annotation.colorbar = true;
    const std::vector<ColorBar> bars = annotation_of(scene, settings).bars;
    ASSERT_EQ(bars.size(), 2u);
    EXPECT_EQ(bars[0].title, "s (a + 1 more)");
    EXPECT_EQ(bars[0].nan_color, (Rgba8{255, 0, 0, 255}));
    EXPECT_EQ(bars[1].title, "s (b)");
    EXPECT_EQ(bars[1].nan_color, (Rgba8{0, 0, 255, 255}));
}

// DejaVu Sans has Greek and no Chinese.
TEST(Font, NamesWhatItLacks) {
    EXPECT_EQ(missing_characters("a \u0394 \u5730\u9762 \u5730"), (Texts{"\u5730", "\u9762"}));
    EXPECT_EQ(missing_characters("\xff\n"), Texts());
    Texts told;
    set_log_sink([&](LogLevel, std::string_view message) { told.emplace_back(message); });
    SceneWarnings warnings;
    const Annotation annotation{{{"\u8eca", {{"\u5730\u9762", red}, {"tree", red}}}}, {red_bar("\u8eca")}};
    for (int i = 0; i < 2; ++i) warnings.check(annotation, {}, {640, 480});
    std::string name;
    for (int i = 0; i < 10; ++i) name += std::string("\xe4\xb8") + char(0x80 + i);  // U+4E00 to U+4E09
    SceneWarnings().check({{{"", {{name, red}}}}, {}}, {}, {640, 480});
    set_log_sink({});
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(told[0],
              "annotation: the font, DejaVu Sans, lacks \u8eca, \u5730, \u9762: boxes are drawn instead");
    EXPECT_NE(told[1].find(" and 2 more: "), std::string::npos);
}

}  // namespace easypbr::app::colorbar_layout_test
