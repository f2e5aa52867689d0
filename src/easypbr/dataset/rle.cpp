#include "easypbr/dataset/rle.h"

#include <fmt/format.h>

#include <numeric>

#include "easypbr/core/error.h"

namespace easypbr::dataset {

std::vector<uint32_t> rle_counts(std::span<const uint8_t> mask, int width, int height) {
    std::vector<uint32_t> counts;
    bool value = false;
    uint32_t run = 0;
    for (size_t x = 0; x < size_t(width); ++x)
        for (size_t y = 0; y < size_t(height); ++y) {
            if (bool(mask[y * size_t(width) + x]) != value) {
                counts.push_back(run);
                run = 0;
                value = !value;
            }
            ++run;
        }
    counts.push_back(run);
    return counts;
}

std::string rle_string(std::span<const uint32_t> counts) {
    std::string text;
    for (size_t i = 0; i < counts.size(); ++i) {
        int64_t rest = int64_t(counts[i]);
        if (i > 2) rest -= int64_t(counts[i - 2]);
        for (bool more = true; more;) {
            int64_t group = rest & 0x1f;
            rest >>= 5;
            more = group & 0x10 ? rest != -1 : rest != 0;
            if (more) group |= 0x20;
            text += char(group + 48);
        }
    }
    return text;
}

std::vector<uint32_t> rle_parse(const std::string& text) {
    std::vector<uint32_t> counts;
    for (size_t at = 0; at < text.size();) {
        int64_t value = 0;
        int shift = 0;
        for (bool more = true; more; shift += 5) {
            const int group = at < text.size() ? text[at++] - 48 : -1;
            if (group < 0 || group > 63 || shift > 30)
                throw FormatError(fmt::format("run lengths: no COCO mask string at byte {}", at));
            value |= int64_t(group & 0x1f) << shift;
            more = group & 0x20;
            if (!more && (group & 0x10)) value |= -(int64_t(1) << (shift + 5));
        }
        if (counts.size() > 2) value += int64_t(counts[counts.size() - 2]);
        if (value < 0 || value > UINT32_MAX)
            throw FormatError(fmt::format("run lengths: a run of {} pixels before byte {}", value, at));
        counts.push_back(uint32_t(value));
    }
    return counts;
}

std::vector<uint8_t> rle_mask(std::span<const uint32_t> counts, int width, int height) {
    const size_t pixels = size_t(width) * size_t(height);
    const size_t sum = std::accumulate(counts.begin(), counts.end(), size_t(0));
    if (sum != pixels)
        throw FormatError(
            fmt::format("run lengths: expected {} pixels ({} x {}), got {}", pixels, width, height, sum));
    std::vector<uint8_t> mask(pixels);
    size_t at = 0;
    for (size_t i = 0; i < counts.size(); ++i)
        for (uint32_t k = 0; k < counts[i]; ++k, ++at)
            mask[at % size_t(height) * size_t(width) + at / size_t(height)] = i % 2;
    return mask;
}

}  // namespace easypbr::dataset
