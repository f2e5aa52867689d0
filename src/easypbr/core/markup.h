// Text in HTML, XML and SVG.
#pragma once

#include <string>
#include <string_view>

namespace easypbr {

/// The text with U+FFFD in place of what is not UTF-8.
std::string valid_utf8(const std::string& text);

/// The text with character references for & < > " '.
std::string markup_escaped(std::string_view text);

}  // namespace easypbr
