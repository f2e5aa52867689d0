// Widths and glyphs of the font that annotations are written in.
#include "easypbr/app/font.h"

#include <gtest/gtest.h>

namespace easypbr::app::font_test {

TEST(Font, HasWidthsAndAlphabets) {
    const Font font(20);
    EXPECT_EQ(font.width(""), 0);
    EXPECT_NEAR(font.width("HHHH"), 4 * font.width("H"), 1e-3);
    EXPECT_LT(font.width("AV"), font.width("A") + font.width("V")) << "kerning";
    // DejaVu Sans: capitals are 1493 of 2048 units high.
    EXPECT_NEAR(font.cap_height(), 20 * 1493.0 / 2048, 0.01);
    for (const char* text : {"\u00e4\u00df\u0394\u0416\u2212", "\xff\xfe", "\xe2\x82", "\xf0\x9f\x9a\x97"}) {
        int touched = 0;
        font.draw(text, 0, 20, [&](int, int, float coverage) {
            EXPECT_GT(coverage, 0);
            EXPECT_LE(coverage, 1);
            ++touched;
        });
        EXPECT_GT(touched, 10) << text;
    }
}

}  // namespace easypbr::app::font_test
