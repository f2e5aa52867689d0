#include "easypbr/io/image/exr_blocks.h"

#include <zlib.h>

#include <algorithm>

namespace easypbr::io {
namespace {

size_t bytes_of(int width, int height, const std::vector<ExrPlane>& planes) {
    size_t words = 0;
    for (const ExrPlane& plane : planes) words += size_t(plane.words);
    return words * 2 * size_t(width) * size_t(height);
}

std::vector<std::byte> inflated(std::span<const std::byte> packed, size_t size) {
    std::vector<std::byte> out(size);
    uLongf length = uLongf(size);
    const int result = ::uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                                    reinterpret_cast<const Bytef*>(packed.data()), uLong(packed.size()));
    if (result != Z_OK || length != size) throw ExrDamage{"a damaged ZIP block"};
    return out;
}

/// A count below 0 stands before that many plain bytes, another before a byte that is repeated once more.
std::vector<std::byte> unrolled(std::span<const std::byte> packed, size_t size) {
    std::vector<std::byte> out;
    out.reserve(size);
    for (size_t at = 0; at < packed.size();) {
        const int count = int(int8_t(packed[at++]));
        const size_t length = size_t(count < 0 ? -count : count + 1);
        const size_t stored = count < 0 ? length : 1;
        if (stored > packed.size() - at || length > size - out.size()) throw ExrDamage{"a damaged RLE block"};
        if (count < 0)
            out.insert(out.end(), packed.begin() + long(at), packed.begin() + long(at + stored));
        else
            out.insert(out.end(), length, packed[at]);
        at += stored;
    }
    if (out.size() != size) throw ExrDamage{"a damaged RLE block"};
    return out;
}

/// Undoes the differences between bytes and joins the halves that hold the even and the odd ones.
std::vector<std::byte> joined(const std::vector<std::byte>& bytes) {
    std::vector<std::byte> out(bytes.size());
    const auto* from = reinterpret_cast<const uint8_t*>(bytes.data());
    auto* to = reinterpret_cast<uint8_t*>(out.data());
    uint8_t last = 128;  // The first byte stands for itself: 128 is taken from each.
    for (size_t first = 0; first < 2; ++first)
        for (size_t i = first; i < bytes.size(); i += 2) to[i] = last = uint8_t(last + *from++ - 128);
    return out;
}

}  // namespace

std::vector<std::byte> decompress_exr(ExrCompression compression, std::span<const std::byte> packed,
                                      int width, int height, const std::vector<ExrPlane>& planes) {
    const size_t size = bytes_of(width, height, planes);
    // A block that compression would have made larger is stored as it is.
    if (packed.size() == size) return {packed.begin(), packed.end()};
    switch (compression) {
        case ExrCompression::rle:
            return joined(unrolled(packed, size));
        case ExrCompression::zip_line:
        case ExrCompression::zip:
            return joined(inflated(packed, size));
        case ExrCompression::piz:
            return decompress_piz(packed, width, height, planes);
        default:
            throw ExrDamage{"a block of wrong size"};
    }
}

}  // namespace easypbr::io
