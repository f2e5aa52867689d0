// Names in small letters or large.
#pragma once

#include <algorithm>
#include <cctype>
#include <string_view>

namespace easypbr {

/// Whether two texts are the same in any case.
inline bool same_letters(std::string_view a, std::string_view b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace easypbr
