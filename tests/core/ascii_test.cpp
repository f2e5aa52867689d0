#include "easypbr/core/ascii.h"

#include <gtest/gtest.h>

#include <climits>
#include <string>
#include <string_view>

namespace easypbr::ascii_test {

// Each byte there is, so that those of UTF-8 and of Latin-1, which are negative as char, are among them.
TEST(Ascii, KnowsItsLettersDigitsAndSpacesAlone) {
    constexpr std::string_view small = "abcdefghijklmnopqrstuvwxyz", large = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    constexpr std::string_view digits = "0123456789", spaces = " \t\n\v\f\r";
    for (int byte = CHAR_MIN; byte <= CHAR_MAX; ++byte) {
        const char c = char(byte);
        const auto is_of = [&](std::string_view set) { return set.find(c) != set.npos; };
        EXPECT_EQ(ascii::is_lower(c), is_of(small)) << byte;
        EXPECT_EQ(ascii::is_upper(c), is_of(large)) << byte;
        EXPECT_EQ(ascii::is_digit(c), is_of(digits)) << byte;
        EXPECT_EQ(ascii::is_space(c), is_of(spaces)) << byte;
        EXPECT_EQ(ascii::is_alpha(c), is_of(small) || is_of(large)) << byte;
        EXPECT_EQ(ascii::is_alnum(c), is_of(small) || is_of(large) || is_of(digits)) << byte;
        EXPECT_EQ(ascii::to_lower(c), is_of(large) ? small[large.find(c)] : c) << byte;
        EXPECT_EQ(ascii::to_upper(c), is_of(small) ? large[small.find(c)] : c) << byte;
    }
}

TEST(Ascii, ChangesTheCaseOfTexts) {
    // The Turkish capital of i and the small letter without a dot stay, as bytes of UTF-8.
    EXPECT_EQ(ascii::to_lower("INTENSITY_3 \u0130"), "intensity_3 \u0130");
    EXPECT_EQ(ascii::to_upper("metallic_3 \u0131"), "METALLIC_3 \u0131");
    EXPECT_TRUE(ascii::same_letters("Indigo", "iNDIGO"));
    EXPECT_FALSE(ascii::same_letters("indigo", "indigo "));
    EXPECT_FALSE(ascii::same_letters("@", "`"));
    EXPECT_TRUE(ascii::same_letters("", ""));
}

}  // namespace easypbr::ascii_test
