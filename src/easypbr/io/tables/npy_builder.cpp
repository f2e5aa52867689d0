#include "easypbr/io/tables/npy_builder.h"

#include <fmt/format.h>

namespace easypbr::io {

std::string npy_header(const std::string& descr, const std::string& shape) {
    constexpr size_t alignment = 64, largest_short = 65535;
    std::string dictionary =
        fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", descr, shape);
    // Version 1 has 16 bits for the size, version 2 has 32.
    const bool is_long = dictionary.size() + alignment > largest_short;
    const size_t before = is_long ? 12 : 10;
    while ((before + dictionary.size() + 1) % alignment) dictionary += ' ';
    dictionary += '\n';
    std::string out = "\x93NUMPY";
    out += char(is_long ? 2 : 1);
    out += '\0';
    for (size_t i = 0; i < (is_long ? 4 : 2); ++i) out += char(dictionary.size() >> (8 * i) & 255);
    return out + dictionary;
}

}  // namespace easypbr::io
