// LZF, the compression of PCD files (M. Lehmann, LibLZF).
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace easypbr::io {

/// Most bytes that `compressed` bytes can become: 3 bytes repeat up to 264.
constexpr size_t lzf_largest_size(size_t compressed) {
    return compressed * 88;
}

/// Decompresses into all of `out`. False when the data are damaged: they would read or write outside, or give
/// another number of bytes.
bool lzf_decompress(std::string_view in, std::span<char> out);

}  // namespace easypbr::io
