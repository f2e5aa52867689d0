#include "easypbr/io/source/json_text.h"

#include <algorithm>

namespace easypbr::io {
namespace {

std::string character_text(char c) {
    if (c == '\n') return "the end of the line";
    if (c >= ' ' && c <= '~') return fmt::format("'{}'", c);
    return fmt::format("the byte 0x{:02x}", static_cast<unsigned char>(c));
}

}  // namespace

std::string json_mistake(std::string_view text, size_t read) {
    const size_t at = std::min(std::max<size_t>(read, 1) - 1, text.size());
    const std::string_view before = text.substr(0, at);
    const auto lines = std::ranges::count(before, '\n');
    const size_t column = at - (before.rfind('\n') + 1);  // npos + 1 is 0.
    return fmt::format("line {}, column {}: expected JSON, got {}", lines + 1, column + 1,
                       at == text.size() ? "the end of the text" : character_text(text[at]));
}

}  // namespace easypbr::io
