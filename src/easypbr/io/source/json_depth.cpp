#include "easypbr/io/source/json_depth.h"

#include <fmt/format.h>

#include "easypbr/core/error.h"

namespace easypbr::io {
namespace {

constexpr int most_json_levels = 512;

}  // namespace

void check_json_depth(std::string_view text, const std::string& name) {
    int levels = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            for (++i; i < text.size() && text[i] != '"'; ++i)
                if (text[i] == '\\') ++i;
        } else if (c == '[' || c == '{') {
            if (++levels > most_json_levels)
                throw FormatError(fmt::format("cannot read {}: its JSON is nested more than {} levels deep",
                                              name, most_json_levels));
        } else if (c == ']' || c == '}') {
            --levels;
        }
    }
}

}  // namespace easypbr::io
