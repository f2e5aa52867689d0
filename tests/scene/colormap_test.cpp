#include "easypbr/scene/colormap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <ranges>
#include <set>

#include "easypbr/core/error.h"

namespace easypbr::colormap_test {

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();

Array1f values(std::initializer_list<float> list) {
    return Array1f(
        Array1f::Dense(Eigen::Map<const Eigen::VectorXf>(list.begin(), Eigen::Index(list.size()))));
}

}  // namespace

// First, middle and last entries as the maps' authors publish them.
TEST(Colormap, TablesHaveThePublishedColours) {
    const auto entry = [](Colormap map, size_t i) { return color_table(map)[i]; };
    EXPECT_EQ(entry(Colormap::viridis, 0), (Rgb8{68, 1, 84}));
    EXPECT_EQ(entry(Colormap::viridis, 128), (Rgb8{33, 145, 140}));
    EXPECT_EQ(entry(Colormap::viridis, 255), (Rgb8{253, 231, 37}));
    EXPECT_EQ(entry(Colormap::plasma, 0), (Rgb8{13, 8, 135}));
    EXPECT_EQ(entry(Colormap::plasma, 255), (Rgb8{240, 249, 33}));
    EXPECT_EQ(entry(Colormap::inferno, 0), (Rgb8{0, 0, 4}));
    EXPECT_EQ(entry(Colormap::inferno, 255), (Rgb8{252, 255, 164}));
    EXPECT_EQ(entry(Colormap::magma, 255), (Rgb8{252, 253, 191}));
    EXPECT_EQ(entry(Colormap::turbo, 0), (Rgb8{48, 18, 59}));
    EXPECT_EQ(entry(Colormap::turbo, 255), (Rgb8{122, 4, 3}));
    EXPECT_EQ(entry(Colormap::cividis, 0), (Rgb8{0, 34, 78}));
    EXPECT_EQ(entry(Colormap::cividis, 255), (Rgb8{254, 232, 56}));
    for (size_t i = 0; i < 256; ++i)
        EXPECT_EQ(entry(Colormap::grey, i), (Rgb8{uint8_t(i), uint8_t(i), uint8_t(i)}));
}

// The table of 33 colours in Moreland 2009, appendix; ours has 256, so the even entries of 33 lie between two
// of them: a step of the map is up to 1.5 codes, and the paper's codes are rounded.
TEST(Colormap, CoolwarmIsThatOfThePaper) {
    constexpr int published[33][3] = {
        {59, 76, 192},   {68, 90, 204},   {77, 104, 215},  {87, 117, 225},  {98, 130, 234},  {108, 142, 241},
        {119, 154, 247}, {130, 165, 251}, {141, 176, 254}, {152, 185, 255}, {163, 194, 255}, {174, 201, 253},
        {184, 208, 249}, {194, 213, 244}, {204, 217, 238}, {213, 219, 230}, {221, 221, 221}, {229, 216, 209},
        {236, 211, 197}, {241, 204, 185}, {245, 196, 173}, {247, 187, 160}, {247, 177, 148}, {247, 166, 135},
        {244, 154, 123}, {241, 141, 111}, {236, 127, 99},  {229, 112, 88},  {222, 96, 77},   {213, 80, 66},
        {203, 62, 56},   {192, 40, 47},   {180, 4, 38}};
    const ColorTable& table = color_table(Colormap::coolwarm);
    for (int i = 0; i <= 32; ++i) {
        const double at = i * 255.0 / 32;
        const size_t below = size_t(at), above = std::min<size_t>(255, below + 1);
        for (size_t k = 0; k < 3; ++k) {
            const double ours = table[below][k] + (at - double(below)) * (table[above][k] - table[below][k]);
            EXPECT_NEAR(ours, published[i][k], 1.5) << i << " " << k;
        }
    }
    EXPECT_EQ(table[0], (Rgb8{59, 76, 192}));
    EXPECT_EQ(table[255], (Rgb8{180, 4, 38}));
}

TEST(Colormap, NamesAreSuggested) {
    EXPECT_EQ(colormap_names().size(), 16u);
    for (const std::string& name : colormap_names()) EXPECT_EQ(parse_colormap(name).text(), name);
    EXPECT_EQ(parse_colormap("Turbo"), Colormap::turbo);
    try {
        parse_colormap("viridiss");
        FAIL();
    } catch (const NameError& error) {
        EXPECT_STREQ(
            error.what(),
            "there is no colormap 'viridiss' (did you mean 'viridis'?): expected viridis, plasma, "
            "inferno, magma, turbo, cividis, grey, coolwarm, one of these with _r behind it (reversed), "
            "or colours such as '#000080,#ffffff,#800000'");
    }
}

TEST(Colormap, ReversedMapsHaveTheColoursInTheOppositeOrder) {
    for (const std::string& name : colormap_names()) {
        const Colormap map = parse_colormap(name);
        const ColorTable table = color_table(map), reversed = color_table(map.reversed());
        EXPECT_TRUE(std::ranges::equal(reversed, std::views::reverse(table))) << name;
        EXPECT_EQ(map.reversed().reversed(), map);
        EXPECT_NE(map.reversed(), map);
    }
    EXPECT_EQ(Colormap::magma.reversed().text(), "magma_r");
    EXPECT_EQ(parse_colormap("#000000,#ff0000").reversed().text(), "#ff0000,#000000");
    EXPECT_TRUE(parse_colormap("coolwarm_r").is_diverging() && parse_colormap("grey_r").is_grey());
    EXPECT_FALSE(Colormap::viridis.is_diverging() || Colormap::viridis.is_grey());
}

// Entry i stands at i / 255 of the way through the colours.
TEST(Colormap, OwnColoursAreEvenlySpacedAndInterpolatedInSrgb) {
    const ColorTable two = color_table(parse_colormap("#000000,#ff0000"));
    for (size_t i = 0; i < 256; ++i) EXPECT_EQ(two[i], (Rgb8{uint8_t(i), 0, 0}));
    // 51 and 204 are 2/5 and 8/5 of the way between the three: 0.4 and 0.6 of a pair's, times 255.
    const ColorTable three = color_table(parse_colormap("navy, #fff ,#800000"));
    EXPECT_EQ(three[0], (Rgb8{0, 0, 128}));
    EXPECT_EQ(three[51], (Rgb8{102, 102, 179}));  // 128 + 0.4 * 127 = 178.8
    EXPECT_EQ(three[204], (Rgb8{179, 102, 102}));
    EXPECT_EQ(three[255], (Rgb8{128, 0, 0}));
    const Colormap array(Array3f(Array3f::Dense{{0, 0, 128 / 255.0f}, {1, 1, 1}, {128 / 255.0f, 0, 0}}));
    EXPECT_EQ(array, parse_colormap("navy,#fff,#800000"));
    EXPECT_EQ(array.text(), "#000080,#ffffff,#800000");
    EXPECT_FALSE(array.is_diverging() || array == Colormap::viridis);
}

TEST(Colormap, ATableIsAMapOfTheSameTable) {
    const ColorTable table = color_table(Colormap::turbo);
    const Colormap copy(std::vector<Rgb8>(table.begin(), table.end()));
    EXPECT_EQ(color_table(copy), table);
    EXPECT_EQ(color_table(parse_colormap(copy.text())), table);
    // Of 511 colours every other one stands at one of 256 even places.
    std::vector<Rgb8> many(511, Rgb8{9, 9, 9});
    for (size_t i = 0; i < 256; ++i) many[2 * i] = table[i];
    EXPECT_EQ(color_table(Colormap(many)), table);
}

// 1e-31 is a fifth of the way from 0 to 5e-31: part 51 of 256.
TEST(ColorScale, TinyValuesHaveRangesOfTheirOwn) {
    const ValueRange given = value_range(values({1e-31f, 5e-31f}), 0.0f, 5e-31f);
    EXPECT_EQ(std::pair(given.min, given.max), std::pair(0.0f, 5e-31f));
    EXPECT_EQ(color_index(1e-31f, given), 51);
    const ValueRange automatic = automatic_range(values({1e-31f, 5e-31f}));
    EXPECT_EQ(std::pair(automatic.min, automatic.max), std::pair(1e-31f, 5e-31f));
    // Differences without all their digits, and none at all, are not divided by.
    EXPECT_EQ(color_index(1e-40f, automatic_range(values({0.0f, 1e-40f}))), 128);
    for (const float same : {0.0f, 1e-40f, 7.0f}) {
        const ValueRange wide = automatic_range(values({same, same}));
        EXPECT_EQ(color_index(same, wide), 128) << same;
    }
}

// The middle of 1 to 100 on a logarithmic scale is their geometric mean, 10.
TEST(ColorScale, LogarithmsAreSpreadEvenly) {
    const ValueRange range = value_range(values({1, 100, 0, -3, no_value}), {}, {}, false, ColorScale::log);
    EXPECT_EQ(range.min, 1);
    EXPECT_EQ(range.max, 100);
    EXPECT_EQ(color_index(1, range), 0);
    EXPECT_EQ(color_index(10, range), 128);
    EXPECT_EQ(color_index(100, range), 255);
    EXPECT_EQ(color_index(0.5f, range), 0);
    EXPECT_EQ(color_index(inf, range), 255);
    for (const float missing : {0.0f, -1.0f, -inf, no_value}) EXPECT_EQ(color_index(missing, range), -1);
    // The centre of each part, so that rounding of the value decides nothing.
    for (int i = 0; i < 256; ++i) EXPECT_EQ(color_index(float(std::pow(100.0, (i + 0.5) / 256)), range), i);
    // No such value, and one of them: it is in the middle, half a decade from both ends.
    const ValueRange none = automatic_range(values({0, -1}), false, ColorScale::log);
    EXPECT_EQ(std::pair(none.min, none.max), std::pair(1.0f, 10.0f));
    const ValueRange one = automatic_range(values({5, 0}), false, ColorScale::log);
    EXPECT_NEAR(one.max / one.min, 10, 1e-5);  // float32
    EXPECT_NEAR(color_index(5, one), 128, 1);
}

TEST(ColorScale, EndsOfALogarithmicRangeAreAboveZero) {
    const Array1f data = values({1, 100});
    for (const float end : {0.0f, -1.0f}) {
        EXPECT_THROW(value_range(data, end, {}, false, ColorScale::log), ArgumentError);
        EXPECT_THROW(value_range(data, {}, end, false, ColorScale::log), ArgumentError);
        EXPECT_NO_THROW(value_range(data, end, {}));
    }
    EXPECT_EQ(value_range(data, 0.1f, 1e3f, false, ColorScale::log).min, 0.1f);
}

// Bands of whole entries: 10 bands of 25, then the last colour again.
TEST(Colormap, StepsAreEqualBands) {
    const ColorTable whole = color_table(Colormap::grey), bands = color_table(Colormap::grey, 10);
    EXPECT_EQ(color_parts(10), 250);
    std::set<Rgb8> colors(bands.begin(), bands.end());
    EXPECT_EQ(colors.size(), 10u);
    for (size_t i = 0; i < 256; ++i) {
        const size_t band = std::min<size_t>(i / 25, 9);
        EXPECT_EQ(bands[i][0], std::lround(double(band) * 255 / 9)) << i;
    }
    ValueRange range{0, 1, 0, 1};
    range.parts = color_parts(10);
    // A value just above and just below the border of two bands: they differ by one band.
    for (int band = 1; band < 10; ++band) {
        EXPECT_EQ(color_index(float(band) / 10 + 1e-5f, range) / 25, band);
        EXPECT_EQ(color_index(float(band) / 10 - 1e-5f, range) / 25, band - 1);
    }
    EXPECT_EQ(color_index(2, range), 249);
    EXPECT_EQ(color_table(Colormap::grey, 0), whole);
    EXPECT_EQ(color_parts(0), 256);
    EXPECT_EQ(color_table(Colormap::grey, 256), whole);
    EXPECT_EQ(color_table(Colormap::grey, 1)[7], whole[128]);
}

TEST(Colormap, HasUpTo256Bands) {
    for (const int steps : {-1, 257, 100000}) {
        EXPECT_THROW((void)color_parts(steps), ArgumentError) << steps;
        EXPECT_THROW((void)color_table(Colormap::viridis, steps), ArgumentError) << steps;
    }
}

TEST(Colormap, BadColoursAreNamed) {
    const auto told = [](auto&& make) -> std::string {
        try {
            make();
        } catch (const ArgumentError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(told([] { parse_colormap("#ffffff"); }), "colormap: expected at least 2 colours, got 1");
    EXPECT_EQ(told([] { Colormap(std::vector<Rgb8>()); }), "colormap: expected at least 2 colours, got 0");
    EXPECT_EQ(told([] { parse_colormap("red,#12"); }).find("colormap: colour 2: "), 0u);
    EXPECT_EQ(told([] { parse_colormap("red,"); }).find("colormap: colour 2: "), 0u);
    EXPECT_EQ(told([] {
                  Colormap(Array3f(Array3f::Dense{{0, 0, 0}, {0, 0, 1.5f}}));
              }),
              "colormap: expected colours of three numbers from 0 to 1, got (0, 0, 1.5) in row 1 of 2");
    EXPECT_NE(told([] { Colormap(Array3f(Array3f::Dense{{0, 0, 0}, {0, no_value, 1}})); }), "accepted");
}

TEST(Colormap, RangeIsCutIntoEqualParts) {
    const ValueRange range{-1, 1, -1, 1};
    EXPECT_EQ(color_index(-1, range), 0);
    EXPECT_EQ(color_index(1, range), 255);
    EXPECT_EQ(color_index(0, range), 128);
    EXPECT_EQ(color_index(-5, range), 0);
    EXPECT_EQ(color_index(-inf, range), 0);
    EXPECT_EQ(color_index(inf, range), 255);
    EXPECT_EQ(color_index(no_value, range), -1);
    // Powers of two: exact. The middle of each part has its colour.
    for (int i = 0; i < 256; ++i) EXPECT_EQ(color_index(-1 + (float(i) + 0.5f) / 128, range), i);
}

TEST(Colormap, AutomaticRangeIsThatOfTheFiniteValues) {
    const ValueRange range = automatic_range(values({3, no_value, -2, inf, 7, -inf}));
    EXPECT_EQ(range.min, -2);
    EXPECT_EQ(range.max, 7);
    EXPECT_FALSE(range.clips_below() || range.clips_above());
    const ValueRange none = automatic_range(values({no_value, inf}));
    EXPECT_EQ(none.min, 0);
    EXPECT_EQ(none.max, 1);
    EXPECT_EQ(automatic_range({}).max, 1);
}

TEST(Colormap, OneValueHasTheMiddleColour) {
    for (const float value : {0.0f, 5.0f, -3e20f, 1e-35f, 16777216.0f}) {
        const ValueRange range = automatic_range(values({value, value, no_value}));
        EXPECT_LT(range.min, range.max);
        EXPECT_NEAR(color_index(value, range), 128, 1) << value;
    }
}

TEST(Colormap, HugeValuesHaveColours) {
    const float most = std::numeric_limits<float>::max();
    const ValueRange range = automatic_range(values({-most, 0, most}));
    EXPECT_EQ(color_index(-most, range), 0);
    EXPECT_EQ(color_index(0, range), 128);
    EXPECT_EQ(color_index(most, range), 255);
}

// 1000 normally distributed values: all are in the range. With one of a million among them the range is that
// of the percentiles: of the standard normal distribution, -2.326 and 2.326, here with a sampling error of
// sqrt(0.01 * 0.99 / 1000) / density(2.326) = 0.12.
TEST(Colormap, OutliersDoNotTakeAllColours) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    Array1f::Dense plain(1000);
    for (float& value : plain) value = normal(random);
    const ValueRange whole = automatic_range(Array1f(plain));
    EXPECT_EQ(whole.min, plain.minCoeff());
    EXPECT_EQ(whole.max, plain.maxCoeff());
    plain(500) = 1e6f;
    const ValueRange central = automatic_range(Array1f(plain));
    EXPECT_NEAR(central.min, -2.326, 0.36);  // three standard errors
    EXPECT_NEAR(central.max, 2.326, 0.36);
    EXPECT_TRUE(central.clips_below() && central.clips_above());
    EXPECT_EQ(central.data_max, 1e6f);
    // A mask of a few ones: its percentiles are equal, its range is whole.
    Array1f::Dense mask = Array1f::Dense::Zero(1000);
    mask(7) = 1;
    EXPECT_EQ(automatic_range(Array1f(mask)).max, 1);
}

TEST(Colormap, DivergingRangesAreCentredOnZero) {
    const ValueRange range = automatic_range(values({-1, 4}), true);
    EXPECT_EQ(range.min, -4);
    EXPECT_EQ(range.max, 4);
    EXPECT_EQ(color_index(0, range), 128);
    EXPECT_EQ(automatic_range(values({1, 4}), true).min, 1);
}

TEST(Colormap, GivenEndsReplaceInferredOnes) {
    const Array1f data = values({0, 10});
    const auto range = [&](std::optional<float> min, std::optional<float> max) {
        const ValueRange r = value_range(data, min, max);
        return std::pair(r.min, r.max);
    };
    EXPECT_EQ(range({}, {}), std::pair(0.0f, 10.0f));
    EXPECT_EQ(range(2, {}), std::pair(2.0f, 10.0f));
    EXPECT_EQ(range({}, 3), std::pair(0.0f, 3.0f));
    EXPECT_EQ(range(2, 3), std::pair(2.0f, 3.0f));
    EXPECT_TRUE(value_range(data, 2, 3).clips_above());
    // Beyond all values: everything has the end's colour or less.
    EXPECT_EQ(color_index(10, value_range(data, 20, {})), 0);
    EXPECT_EQ(color_index(0, value_range(data, {}, -20)), 255);
    EXPECT_THROW(value_range(data, 3, 2), ArgumentError);
    // Equal ends are no error: 5 is in the middle, as a single value is.
    const ValueRange point = value_range(data, 5, 5);
    EXPECT_EQ(std::pair(point.min, point.max), std::pair(4.5f, 5.5f));
}

}  // namespace easypbr::colormap_test
