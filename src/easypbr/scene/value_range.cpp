// Which values the colours of a colour map are spread over.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/colormap.h"

namespace easypbr {
namespace {

constexpr size_t palette_grain = 1 << 16;
constexpr Eigen::Index most_samples = 1 << 18;
/// Differences of values up to here are finite.
constexpr float largest = 1e38f;
/// Smaller differences have lost digits, or are 0.
constexpr float smallest_span = std::numeric_limits<float>::min();

struct Extent {
    float min = std::numeric_limits<float>::infinity(), max = -std::numeric_limits<float>::infinity();

    void add(const Extent& other) {
        min = std::min(min, other.min);
        max = std::max(max, other.max);
    }
};

/// Whether a value counts for the range.
bool has_place(float value, ColorScale scale) {
    return std::isfinite(value) && (scale == ColorScale::linear || value > 0);
}

/// Distances along the scale are differences of these.
double along(float value, ColorScale scale) {
    return scale == ColorScale::linear ? double(value) : std::log10(double(value));
}

Extent finite_extent(const Array1f& values, ColorScale scale) {
    const size_t count = size_t(values.rows());
    std::vector<Extent> parts((count + palette_grain - 1) / palette_grain);
    parallel_chunks(count, palette_grain, [&](size_t begin, size_t end) {
        Extent& part = parts[begin / palette_grain];
        for (size_t i = begin; i < end; ++i)
            if (const float value = values(Eigen::Index(i)); has_place(value, scale))
                part.add({value, value});
    });
    Extent all;
    for (const Extent& part : parts) all.add(part);
    return all;
}

/// 1st and 99th percentile.
Extent central_extent(const Array1f& values, ColorScale scale) {
    const Eigen::Index step = (values.rows() + most_samples - 1) / most_samples;
    std::vector<float> samples;
    for (Eigen::Index i = 0; i < values.rows(); i += step)
        if (has_place(values(i), scale)) samples.push_back(values(i));
    if (samples.empty()) return {};
    const auto at = [&](double part) {
        const auto place =
            samples.begin() + std::ptrdiff_t(std::floor(part * double(samples.size() - 1) + 0.5));
        std::nth_element(samples.begin(), place, samples.end());
        return *place;
    };
    return {at(0.01), at(0.99)};
}

/// So wide that it can be divided by, with what it held in the middle.
void widen(ValueRange& range) {
    if (range.scale == ColorScale::log) {
        if (range.min < range.max) return;
        const float half_decade = std::sqrt(10.0f);
        range.min = std::max(range.min / half_decade, std::numeric_limits<float>::denorm_min());
        range.max *= half_decade;
        return;
    }
    if (range.max - range.min >= smallest_span) return;
    // The ends stay apart as floats, beside the true value and beside the base.
    const auto half =
        float(std::max({0.5, std::abs(range.true_min()) * 1e-3, std::abs(double(range.min)) * 2e-7}));
    range.min -= half;
    range.max += half;
}

void require_above_zero(const char* name, const std::optional<float>& end) {
    if (end && !(*end > 0))
        throw ArgumentError(
            fmt::format("style: expected {} above 0, as color_scale is log, got {}", name, *end));
}

/// Of true values.
ValueRange zero_to_one(double base) {
    const auto min = float(-base), max = float(1 - base);
    return {min, max, min, max, ColorScale::linear, 256, base};
}

}  // namespace

ValueRange automatic_range(const Array1f& values, bool diverging, ColorScale scale, double base) {
    const Extent all = finite_extent(values, scale);
    if (!(all.min <= all.max))
        return scale == ColorScale::linear ? zero_to_one(base) : ValueRange{1, 10, 1, 10, scale};
    ValueRange range{all.min, all.max, all.min, all.max, scale, 256, base};
    const Extent central = central_extent(values, scale);
    const double spread = along(central.max, scale) - along(central.min, scale);
    if (spread > 0 && spread * 3 < along(all.max, scale) - along(all.min, scale)) {
        range.min = central.min;
        range.max = central.max;
    }
    range.min = std::clamp(range.min, -largest, largest);
    range.max = std::clamp(range.max, -largest, largest);
    if (diverging && range.true_min() < 0 && range.true_max() > 0) {
        const double farthest = std::max(range.true_max(), -range.true_min());
        range.max = float(farthest - base);
        range.min = float(-farthest - base);
    }
    widen(range);
    return range;
}

ValueRange value_range(const Array1f& values, std::optional<float> min, std::optional<float> max,
                       bool diverging, ColorScale scale, double base) {
    if (scale == ColorScale::log) {
        require_above_zero("color_min", min);
        require_above_zero("color_max", max);
    }
    ValueRange range = automatic_range(values, diverging, scale, base);
    if (!min && !max) return range;
    if (min) range.min = float(double(*min) - base);
    if (max) range.max = float(double(*max) - base);
    if (min && max && *min > *max)
        throw ArgumentError(
            fmt::format("style: expected color_min not above color_max, got {} and {}", *min, *max));
    // One end beyond all values is the middle of a range.
    if (min && !max) range.max = std::max(range.max, range.min);
    if (max && !min) range.min = std::min(range.min, range.max);
    // Given ends that round to one, beside the base, meet in the steepest range.
    if (min && max && *min < *max && !(range.min < range.max))
        range.max = std::nextafter(range.min, std::numeric_limits<float>::infinity());
    widen(range);
    return range;
}

}  // namespace easypbr
