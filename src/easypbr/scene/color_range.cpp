#include "easypbr/scene/color_range.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "easypbr/core/parallel.h"

namespace easypbr {
namespace {

constexpr size_t range_grain = 1 << 15;

ColorRange both(const ColorRange& a, const ColorRange& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// Of the numbers that `counts` takes.
template <class Counts>
ColorRange range_where(const ArrayXf::Dense& C, const Counts& counts) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const ColorRange none{infinity, -infinity};
    const size_t count = size_t(C.size());
    std::vector<ColorRange> ranges((count + range_grain - 1) / range_grain, none);
    parallel_chunks(count, range_grain, [&](size_t begin, size_t end) {
        ColorRange range = none;
        for (size_t i = begin; i < end; ++i)
            if (const float value = C.data()[i]; counts(value)) range = both(range, {value, value});
        ranges[begin / range_grain] = range;
    });
    ColorRange all = none;
    for (const ColorRange& range : ranges) all = both(all, range);
    return all.low > all.high ? ColorRange() : all;
}

}  // namespace

ColorRange range_of_colors(const ArrayXf::Dense& C) {
    return range_where(C, [](float value) { return !std::isnan(value); });
}

float white_of(const ColorRange& range) {
    return range.high < 2 ? 1.0f : range.high <= 255 ? 255.0f : 65535.0f;
}

void normalize_colors(ArrayXf::Dense& C) {
    const float white = white_of(range_where(C, [](float value) { return std::isfinite(value); }));
    if (white == 1) return;
    parallel_for(size_t(C.size()), range_grain, [&](size_t i) { C.data()[i] /= white; });
}

}  // namespace easypbr
