// Letters, digits and white space of ASCII. The functions of <cctype> go by the program's locale, which makes
// other letters of these (Turkish: the capital of 'i' is no ASCII letter) or finds letters in bytes of UTF-8.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace easypbr::ascii {

constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

constexpr bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}

constexpr bool is_upper(char c) {
    return c >= 'A' && c <= 'Z';
}

constexpr bool is_alpha(char c) {
    return is_lower(c) || is_upper(c);
}

constexpr bool is_alnum(char c) {
    return is_alpha(c) || is_digit(c);
}

/// Line feeds included.
constexpr bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

constexpr char to_lower(char c) {
    return is_upper(c) ? char(c - 'A' + 'a') : c;
}

constexpr char to_upper(char c) {
    return is_lower(c) ? char(c - 'a' + 'A') : c;
}

/// The text with small letters for capitals; other bytes stay.
inline std::string to_lower(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = to_lower(c);
    return out;
}

/// The text with capitals for small letters; other bytes stay.
inline std::string to_upper(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = to_upper(c);
    return out;
}

/// Whether two texts are the same but for small letters and capitals.
constexpr bool same_letters(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, [](char x, char y) { return to_lower(x) == to_lower(y); });
}

}  // namespace easypbr::ascii
