// Names of colours: the 148 of CSS (CSS Color Module Level 4, section 6.1), of which X11's and SVG's are a
// part.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr {

/// 0xrrggbb of a name in upper or lower case.
std::optional<unsigned> named_color(std::string_view name);

/// All names, in the order of the alphabet.
std::vector<std::string> color_names();

}  // namespace easypbr
