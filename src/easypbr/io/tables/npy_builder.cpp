#include "easypbr/io/tables/npy_builder.h"

#include <fmt/format.h>

#include <algorithm>

namespace easypbr::io {

std::string npy_header(const std::string& descr, const std::string& shape) {
    constexpr size_t alignment = 64, largest_short = 65535;
    std::string dictionary =
        fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", descr, shape);
    // Version 1 has 16 bits for the size, version 2 has 32, version 3 names in UTF-8 too.
    const bool is_ascii =
        std::ranges::all_of(dictionary, [](char c) { return static_cast<unsigned char>(c) < 128; });
    const bool is_long = !is_ascii || dictionary.size() + alignment > largest_short;
    const size_t before = is_long ? 12 : 10;
    while ((before + dictionary.size() + 1) % alignment) dictionary += ' ';
    dictionary += '\n';
    std::string out = "\x93NUMPY";
    out += char(!is_ascii ? 3 : is_long ? 2 : 1);
    out += '\0';
    for (size_t i = 0; i < (is_long ? 4 : 2); ++i) out += char(dictionary.size() >> (8 * i) & 255);
    return out + dictionary;
}

}  // namespace easypbr::io
