#include "easypbr/core/color.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/named_colors.h"

namespace easypbr::color_test {

// IEC 61966-2-1 evaluated by hand: 1.055 * 0.18^(1/2.4) - 0.055 and 1.055 * 0.5^(1/2.4) - 0.055.
// Tolerance: half a unit of the fifth digit they are given with.
TEST(Color, EncodesByTheExactCurve) {
    EXPECT_NEAR(srgb_from_linear(0.18f), 0.46136f, 5e-6);
    EXPECT_NEAR(srgb_from_linear(0.5f), 0.73536f, 5e-6);
    EXPECT_FLOAT_EQ(srgb_from_linear(0.001f), 0.01292f);
    EXPECT_FLOAT_EQ(srgb_from_linear(1.0f), 1.0f);
}

TEST(Color, DecodesWhatItEncodes) {
    // Two float powers of about 1 ulp each, magnified by the curve's slope (up to 12.92 near black).
    for (int i = 0; i <= 255; ++i)
        EXPECT_NEAR(linear_from_srgb(srgb_from_linear(i / 255.0f)), i / 255.0f, 2e-6);
    EXPECT_EQ(srgb8_table()[0], 0.0f);
    EXPECT_EQ(srgb8_table()[255], 1.0f);
}

TEST(Color, ReadsEverySpelling) {
    EXPECT_EQ(parse_color("#ff8000"), Vec3(1, 128 / 255.0f, 0));
    EXPECT_EQ(parse_color("#f80"), Vec3(1, 136 / 255.0f, 0));
    EXPECT_EQ(parse_color("0.25,0.5,1"), Vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(parse_color("white"), Vec3(1, 1, 1));
    EXPECT_EQ(to_hex(parse_color("#12ab9f")), "#12ab9f");
}

// Those of codes come from a table.
TEST(Color, DecodesThreeChannelsAsOne) {
    for (int i = 0; i <= 255; ++i) {
        const float code = float(i) / 255;
        for (const float v : {code, std::nextafter(code, 2.0f), code - 2e-3f, code + 1})
            EXPECT_EQ(linear_from_srgb(Vec3(v, 0, 1)), Vec3(linear_from_srgb(v), 0, 1)) << v;
    }
    EXPECT_TRUE(std::isnan(linear_from_srgb(Vec3(std::nanf(""), 0, 0)).x()));
}

TEST(Color, ReadsNamesOfCss) {
    // CSS Color Module Level 4, section 6.1: 148 names, of which seven greys are spelt in two ways, as are
    // cyan and magenta.
    EXPECT_EQ(color_names().size(), 148u);
    EXPECT_EQ(to_hex(parse_color("tomato")), "#ff6347");
    EXPECT_EQ(to_hex(parse_color("RebeccaPurple")), "#663399");
    EXPECT_EQ(to_hex(parse_color("aliceblue")), "#f0f8ff");
    EXPECT_EQ(to_hex(parse_color("yellowgreen")), "#9acd32");
    std::map<std::string, int> spellings;
    for (const std::string& name : color_names()) ++spellings[to_hex(parse_color(name))];
    EXPECT_EQ(spellings.size(), 148u - 9);
}

TEST(Color, RefusesWhatIsNoColor) {
    for (const char* text :
         {"", "#", "#12", "#12345", "#gggggg", "1,2", "1,0,2", "0.1,0.2,0.3,0.4", "-1,0,0", "nan,0,0"})
        EXPECT_THROW(parse_color(text), ArgumentError) << text;
    try {
        parse_color("whte");
        FAIL();
    } catch (const ArgumentError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'white'"), std::string::npos) << error.what();
    }
}

}  // namespace easypbr::color_test
