// Decompression of the blocks of an OpenEXR file (openexr.com, "OpenEXR File Layout" and the codecs it
// names).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace easypbr::io {

enum class ExrCompression : uint8_t { none, rle, zip_line, zip, piz };

/// Thrown by the decoders of blocks; carries no place, which the caller knows.
struct ExrDamage {
    const char* what;
};

/// One channel's samples in a block, as 16-bit words each (1 for half, 2 for float and uint).
struct ExrPlane {
    int words;
};

/// Bytes of a block of width x height pixels, line by line and in each line channel by channel, as many as
/// these have. Throws ExrDamage.
std::vector<std::byte> decompress_exr(ExrCompression compression, std::span<const std::byte> packed,
                                      int width, int height, const std::vector<ExrPlane>& planes);

/// Huffman-coded, wavelet-transformed 16-bit words. Throws ExrDamage.
std::vector<std::byte> decompress_piz(std::span<const std::byte> packed, int width, int height,
                                      const std::vector<ExrPlane>& planes);

}  // namespace easypbr::io
