#include "easypbr/io/archive/zstandard.h"

#include <zstd.h>

namespace easypbr::io {

bool unpack_zstandard(std::string_view packed, std::span<char> out) {
    // An error is a code that no size has.
    return ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size()) == out.size();
}

}  // namespace easypbr::io
