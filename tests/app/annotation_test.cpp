#include "easypbr/app/annotation.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "easypbr/app/font.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/scene/label_colors.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::annotation_test {

namespace {

/// An opaque picture of one grey.
Image plain(PixelType type, int width = 400, int height = 300, uint8_t grey = 64) {
    Image picture(width, height, 4, type);
    Canvas(picture).fill({0, 0, width, height}, {grey, grey, grey});
    return picture;
}

Rgb8 pixel(const Image& picture, int x, int y) {
    const uint8_t* p = picture.at<uint8_t>(x, y);
    return {p[0], p[1], p[2]};
}

ColorBar bar_of(Colormap map, ValueRange range) {
    ColorBar bar;
    bar.title = "t";
    bar.range = range;
    std::ranges::transform(color_table(map), bar.table.begin(), opaque);
    return bar;
}

/// How many rows of a column have a colour of the table, from the first such row on.
struct Found {
    int x = 0, top = 0, height = 0;
};
Found find_bar(const Image& picture, const ColorBar& bar) {
    Found best;
    for (int x = 0; x < picture.width(); ++x) {
        Found here{x, 0, 0};
        for (int y = 0; y < picture.height(); ++y) {
            const Rgb8 color = pixel(picture, x, y);
            if (std::ranges::find(bar.table, opaque(color)) == bar.table.end()) continue;
            if (here.height++ == 0) here.top = y;
        }
        if (here.height > best.height) best = here;
    }
    return best;
}

/// The rectangle of pixels that differ.
PixelRect difference(const Image& a, const Image& b) {
    int left = a.width(), top = a.height(), right = -1, bottom = -1;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            if (!std::equal(a.at<uint8_t>(x, y), a.at<uint8_t>(x, y) + 4, b.at<uint8_t>(x, y))) {
                left = std::min(left, x), right = std::max(right, x);
                top = std::min(top, y), bottom = std::max(bottom, y);
            }
    return {left, top, right - left + 1, bottom - top + 1};
}

Legend legend_of(int count) {
    Legend legend;
    const GeneratedColors colors(count);
    for (int i = 0; i < count; ++i)
        legend.entries.push_back({fmt::format("class {}", i), colors.color_of(i)});
    return legend;
}

/// The places of pixels of exactly this colour.
std::vector<Vec2i> places(const Image& picture, const Rgb8& color) {
    std::vector<Vec2i> found;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            if (pixel(picture, x, y) == color) found.emplace_back(x, y);
    return found;
}

}  // namespace

// Of three bands each takes a third of the rows.
TEST(Annotation, TheBarShowsBands) {
    ColorBar bar = bar_of(Colormap::viridis, {0, 1, 0, 1});
    bar.range.parts = color_parts(3);
    std::ranges::transform(color_table(Colormap::viridis, 3), bar.table.begin(), opaque);
    Image picture = plain(PixelType::u8);
    draw_annotation({{}, {bar}}, {}, picture);
    const Found found = find_bar(picture, bar);
    ASSERT_GT(found.height, 100);
    std::map<Rgb8, int> rows;
    for (int row = 0; row < found.height; ++row) ++rows[pixel(picture, found.x, found.top + row)];
    EXPECT_EQ(rows.size(), 3u);
    for (const auto& [color, count] : rows) EXPECT_NEAR(count, found.height / 3.0, 1);  // whole rows
}

// Row r of H rows from the top is the part of the range around (H - r - 1/2) / H: that entry of 256.
TEST(Annotation, TheBarIsTheTable) {
    for (const Colormap& map : {Colormap::viridis, Colormap::turbo}) {
        const ColorBar bar = bar_of(map, {0, 1, 0, 1});
        Image picture = plain(PixelType::u8);
        draw_annotation({{}, {bar}}, {}, picture);
        const Found found = find_bar(picture, bar);
        ASSERT_GT(found.height, 100);
        for (int row = 0; row < found.height; ++row) {
            const size_t entry = size_t(256 * (found.height - row - 0.5) / found.height);
            EXPECT_EQ(opaque(pixel(picture, found.x, found.top + row)), bar.table[entry]) << row;
        }
    }
}

TEST(Annotation, IsTheSameInEveryPixelType) {
    const Annotation annotation{{legend_of(3)}, {bar_of(Colormap::magma, {0, 1, 0, 1})}};
    Image eight = plain(PixelType::u8), sixteen = plain(PixelType::u16), linear = plain(PixelType::f32);
    for (Image* picture : {&eight, &sixteen, &linear}) draw_annotation(annotation, {}, *picture);
    // Opaque colours: the code, the code times 257, its linear value.
    const Rgb8 swatch = annotation.legends[0].entries[1].color;
    const std::vector<Vec2i> found = places(eight, swatch);
    ASSERT_GT(found.size(), 50u);
    for (const Vec2i& at : found)
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(sixteen.at<uint16_t>(at.x(), at.y())[c], swatch[c] * 257);
            EXPECT_EQ(linear.at<float>(at.x(), at.y())[c], srgb8_table()[swatch[c]]);
        }
    for (int y = 0; y < eight.height(); ++y)
        for (int x = 0; x < eight.width(); ++x)
            for (int c = 0; c < 4; ++c)
                ASSERT_NEAR(sixteen.at<uint16_t>(x, y)[c] / 257.0, eight.at<uint8_t>(x, y)[c], 1.01);
}

TEST(Annotation, SwatchesStandInOrderWithTheirNames) {
    const Legend legend = legend_of(4);
    Image picture = plain(PixelType::u8);
    BasicAnnotationSettings<Inferred> settings;
    settings.text_size = 0.1f;
    draw_annotation({{legend}, {}}, settings, picture);
    int last = -1;
    for (const LegendEntry& entry : legend.entries) {
        const auto found = places(picture, entry.color);
        // A square: as wide as high.
        const int side = found.back().x() - found.front().x() + 1;
        EXPECT_EQ(int(found.size()), side * side);
        EXPECT_GT(found.front().y(), last);
        last = found.back().y();
        // Beside it is light text on the darkened background.
        int ink = 0;
        for (int y = found.front().y(); y <= found.back().y(); ++y)
            for (int x = found.back().x() + 1; x < picture.width(); ++x) ink += pixel(picture, x, y)[0] > 200;
        EXPECT_GT(ink, 100);
    }
}

TEST(Annotation, StandsInItsCornerAndLeavesTheRest) {
    const Image before = plain(PixelType::u8);
    for (const Corner corner :
         {Corner::top_left, Corner::top_right, Corner::bottom_left, Corner::bottom_right}) {
        BasicAnnotationSettings<Inferred> settings;
        settings.corner = corner;
        Image picture = before;
        draw_annotation({{legend_of(3)}, {}}, settings, picture);
        const PixelRect touched = difference(before, picture);
        const bool right = corner == Corner::top_right || corner == Corner::bottom_right;
        const bool bottom = corner == Corner::bottom_left || corner == Corner::bottom_right;
        EXPECT_EQ(touched.x > 200, right);
        EXPECT_EQ(touched.y > 150, bottom);
        EXPECT_LT(touched.width, 120);
        EXPECT_LT(touched.height, 80);
    }
}

TEST(Annotation, GrowsWithThePicture) {
    BasicAnnotationSettings<Inferred> settings;
    settings.text_size = 0.05f;  // in the smaller picture, too, no less than 11 pixels
    const auto size = [&](int scale) {
        const Image before = plain(PixelType::u8, 400 * scale, 300 * scale);
        Image picture = before;
        draw_annotation({{legend_of(5)}, {}}, settings, picture);
        const PixelRect touched = difference(before, picture);
        return Vec2(float(touched.width), float(touched.height));
    };
    // Whole pixels: each of about ten lengths is rounded.
    EXPECT_LT((size(3) - 3 * size(1)).cwiseAbs().maxCoeff(), 15);
}

TEST(Annotation, TextIsDarkOnLightAndLightOnDark) {
    const Legend legend{"", {{"MMMM", {128, 128, 128}}}};
    BasicAnnotationSettings<Inferred> settings;
    settings.text_size = 0.1f;
    for (const uint8_t grey : {0, 255}) {
        const Image before = plain(PixelType::u8, 400, 300, grey);
        Image picture = before;
        draw_annotation({{legend}, {}}, settings, picture);
        const PixelRect touched = difference(before, picture);
        int light = 0, dark = 0;
        for (int y = touched.y; y < touched.y + touched.height; ++y)
            for (int x = touched.x; x < touched.x + touched.width; ++x) {
                light += pixel(picture, x, y)[0] > 220;
                dark += pixel(picture, x, y)[0] < 40;
            }
        EXPECT_GT(grey ? dark : light, 200) << "strokes of the letters";
        EXPECT_GT(grey ? light : dark, 1400) << "what they are written on, at 25 pixels";
    }
}

TEST(Annotation, IsReadableOnNothing) {
    Image picture(400, 300, 4, PixelType::u8);  // transparent
    BasicAnnotationSettings<Inferred> settings;
    settings.text_size = 0.1f;
    draw_annotation({{legend_of(3)}, {}}, settings, picture);
    EXPECT_GT(places(picture, {16, 16, 16}).size(), 200u) << "paper is white, so the text is dark";
    EXPECT_EQ(picture.at<uint8_t>(0, 299)[3], 0) << "the rest stays transparent";
    const Vec2i swatch = places(picture, legend_of(3).entries[0].color).front();
    EXPECT_EQ(picture.at<uint8_t>(swatch.x(), swatch.y())[3], 255);
}

TEST(Annotation, ManyClassesTakeColumnsAndThenSayHowManyAreMissing) {
    const Legend many = legend_of(60), more = legend_of(4000);
    Image picture = plain(PixelType::u8, 800, 300);
    draw_annotation({{many}, {}}, {}, picture);
    std::set<int> columns;
    for (const LegendEntry& entry : many.entries) {
        const auto found = places(picture, entry.color);
        ASSERT_FALSE(found.empty()) << entry.name;
        columns.insert(found.front().x());
    }
    EXPECT_EQ(columns.size(), 3u);  // 60 rows of 13 pixels in 300 less margins; 4 columns are over a third
    Image full = plain(PixelType::u8, 800, 300);
    draw_annotation({{more}, {}}, {}, full);
    EXPECT_FALSE(places(full, more.entries[0].color).empty());
    EXPECT_TRUE(places(full, more.entries[3999].color).empty());
    // Nothing hangs over the borders: the margin is as it was.
    for (int y = 0; y < 300; ++y) EXPECT_EQ(pixel(full, 0, y), (Rgb8{64, 64, 64}));
}

// With work for each pair of entries, or for each number of columns and entry, these would take hours.
TEST(Annotation, HundredThousandsOfClassesTakeNoLongerThanTheirNumber) {
    Image picture = plain(PixelType::u8, 800, 300);
    const Legend many = legend_of(300000);
    draw_annotation({{many}, {}}, {}, picture);
    EXPECT_FALSE(places(picture, many.entries[0].color).empty());
    SceneSnapshot scene;
    MeshData cloud;
    cloud.V = Array3f(Array3f::Dense::Zero(300000, 3));
    cloud.L = Array1i(Array1i::Dense(Eigen::VectorXi::LinSpaced(300000, 0, 299999)));
    scene.objects.push_back({"m", std::make_shared<const MeshData>(cloud), Eigen::Affine3d::Identity()});
    InferredSettings settings;
    settings.camera.up = "+y";
    settings.annotation.legend = true;
    EXPECT_EQ(annotation_of(scene, settings).legends.at(0).entries.size(), 300000u);
    InterruptScope scope([] { return true; });
    EXPECT_THROW((void)annotation_of(scene, settings), Interrupted);
}

TEST(Annotation, HowManyAreMissingStandsBehindTheClassesOfASingleRow) {
    BasicAnnotationSettings<Inferred> settings;
    settings.text_size = 0.2f;
    Image picture = plain(PixelType::u8, 1600, 100);
    const Legend legend = legend_of(100);
    draw_annotation({{legend}, {}}, settings, picture);
    int swatch = 0, ink = 0;  // the last columns of pixels of either
    for (const LegendEntry& entry : legend.entries)
        if (const auto found = places(picture, entry.color); !found.empty())
            swatch = std::max(swatch, found.back().x());
    for (int x = 0; x < picture.width(); ++x)
        for (int y = 0; y < picture.height(); ++y)
            if (std::ranges::min(pixel(picture, x, y)) > 150) ink = x;
    ASSERT_GT(swatch, 0);
    const Font font(20);
    // Glyphs begin within the width that they take, and end in it: a tenth is enough for their bearings.
    EXPECT_GT(float(ink - swatch), font.width("class 9") + 0.9f * font.width("+ 90 more"));
}

TEST(Annotation, LongNamesAndTitlesAreShortened) {
    Legend legend = legend_of(3);
    for (LegendEntry& entry : legend.entries) entry.name = "ctx-lh-caudalanteriorcingulate " + entry.name;
    legend.title = std::string(200, 'T');
    BasicAnnotationSettings<Inferred> settings;
    settings.text_size = 0.08f;
    const int margin = 15;  // 0.8 times a text's size of 0.08 times 240 pixels
    for (const Corner corner : {Corner::top_right, Corner::bottom_left}) {
        settings.corner = corner;
        const Image before = plain(PixelType::u8, 320, 240);
        Image picture = before;
        draw_annotation({{legend}, {}}, settings, picture);
        const PixelRect touched = difference(before, picture);
        EXPECT_GE(touched.x, margin);
        EXPECT_LE(touched.x + touched.width, 320 - margin);
        EXPECT_GT(touched.width, 320 - 2 * margin - 20) << "all but a letter fits, at most 20 pixels wide";
        for (const LegendEntry& entry : legend.entries) {
            const auto found = places(picture, entry.color);
            ASSERT_FALSE(found.empty());
            EXPECT_EQ(int(found.size()), 18 * 18) << "0.95 times the text's size";
        }
    }
}

// Bars of equal colours and values differ in their titles alone: exchanging these changes the picture where
// they can be told apart. At 320 x 240 neither the whole of them fits nor, of the last two, what differs.
TEST(Annotation, ShortenedTitlesAreToldApart) {
    using Titles = std::vector<std::string>;
    for (const Titles& titles :
         {Titles{"error (ours)", "error (baseline)"},
          {"distance to the scan in mm, before", "distance to the scan in mm, after"},
          {"h (mesh/icosphere 1)", "h (mesh/icosphere 2)"},
          {"Abstand: \u00e4u\u00dferer Rand \u00e4", "Abstand: \u00e4u\u00dferer Rand \u00f6"},
          {"signed distance along normals of A", "signed distance along normals of B, filtered"}}) {
        const auto drawn = [&](size_t first) {
            ColorBar bar = bar_of(Colormap::viridis, {0, 1, 0, 1});
            Annotation annotation;
            for (size_t i = 0; i < titles.size(); ++i) {
                bar.title = titles[(first + i) % titles.size()];
                annotation.bars.push_back(bar);
            }
            Image picture = plain(PixelType::u8, 320, 240);
            draw_annotation(annotation, {}, picture);
            return picture;
        };
        const PixelRect changed = difference(drawn(0), drawn(1));
        EXPECT_GT(changed.width, 0) << titles[0];
    }
}

TEST(Annotation, FitsIntoNoPictureWithoutHarm) {
    const Annotation annotation{{legend_of(30)}, {bar_of(Colormap::viridis, {0, 1, -1, 2})}};
    for (const auto& [width, height] : {std::pair(1, 1), {3, 200}, {200, 3}, {64, 48}}) {
        Image picture = plain(PixelType::u8, width, height);
        EXPECT_NO_THROW(draw_annotation(annotation, {}, picture));
    }
}

// Rows of text are 1.4 times its size high: two ticks take a bar of two rows.
TEST(Annotation, BarsFitIntoFlatPicturesAndBesideLargeText) {
    ColorBar bar = bar_of(Colormap::viridis, {0, 1, 0, 1});
    bar.nan_color = Rgba8{255, 0, 255, 255};
    BasicAnnotationSettings<Inferred> large;
    large.text_size = 0.2f;
    Image picture = plain(PixelType::u8, 320, 240);
    draw_annotation({{}, {bar}}, large, picture);
    // Margins and padding take 2.8 sizes, the ends a row, title and missing values one each: with two rows of
    // the bar 9.8 sizes of 240 / 9.8 pixels. Seven lengths are rounded to pixels.
    EXPECT_NEAR(find_bar(picture, bar).height, 2 * 1.4 * 240 / 9.8, 4);
    EXPECT_FALSE(places(picture, {255, 0, 255}).empty());
    // The smallest text has 7 pixels: of 40 pixels margins and padding leave 20, which are two rows of 10.
    Image flat = plain(PixelType::u8, 200, 40);
    draw_annotation({{}, {bar}}, {}, flat);
    EXPECT_EQ(find_bar(flat, bar).height, 10);
    EXPECT_TRUE(places(flat, {255, 0, 255}).empty());
    // One tick: its line is where the bar's right edge has ink.
    std::set<int> lines;
    const int right = find_bar(flat, bar).x + 8;  // the bar is 1.1 times 7 pixels wide
    for (int y = 0; y < 40; ++y)
        if (std::ranges::min(pixel(flat, right, y)) > 200) lines.insert(y);
    EXPECT_EQ(lines.size(), 1u);
}

TEST(Annotation, ArrowsSayThatValuesGoOn) {
    ColorBar bar = bar_of(Colormap::viridis, {0, 1, 0, 1});
    Image closed = plain(PixelType::u8), open = plain(PixelType::u8);
    draw_annotation({{}, {bar}}, {}, closed);
    bar.range.data_max = 2;
    bar.range.data_min = -1;
    draw_annotation({{}, {bar}}, {}, open);
    const auto count = [&](const Image& picture, size_t entry) {
        return places(picture, {bar.table[entry][0], bar.table[entry][1], bar.table[entry][2]}).size();
    };
    EXPECT_GT(count(open, 255), count(closed, 255) + 20);
    EXPECT_GT(count(open, 0), count(closed, 0) + 20);
}

}  // namespace easypbr::app::annotation_test
