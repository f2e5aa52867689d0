// Colormaps: from a value to one of 256 colours.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/scene/array.h"

namespace easypbr {

using ColorTable = std::array<Rgb8, 256>;

/// A colour map: a built-in one, or a table of own colours. A small value; copies share the table.
///
/// viridis, plasma, inferno, magma and cividis are perceptually uniform; turbo is a smoother rainbow; grey is
/// black to white in sRGB; coolwarm diverges from a light grey (Moreland 2009, "Diverging Color Maps for
/// Scientific Visualization").
class Colormap {
  public:
    static const Colormap viridis, plasma, inferno, magma, turbo, cividis, grey, coolwarm;

    /// viridis.
    constexpr Colormap() noexcept = default;
    /// sRGB colours in [0, 1], one a row, evenly spaced: the first stands for the least value, the last for
    /// the largest, and what is between is interpolated in sRGB. They are rounded to 8 bits; of more than 256
    /// those at 256 even places count. Throws ArgumentError for fewer than two, and for other numbers.
    explicit Colormap(const Array3f& colors);
    explicit Colormap(const std::vector<Rgb8>& colors);

    /// The same colours in the opposite order.
    Colormap reversed() const;

    /// The built-in map, or its reversed one.
    bool is_grey() const { return *this == grey || *this == grey.reversed(); }
    bool is_diverging() const { return *this == coolwarm || *this == coolwarm.reversed(); }

    /// "viridis", "viridis_r", or the table's colours as "#000080,#ffffff": parse_colormap() gives the same
    /// map.
    std::string text() const;

    bool operator==(const Colormap& other) const;

  private:
    friend Colormap parse_colormap(std::string_view text);
    friend ColorTable color_table(const Colormap& colormap);

    constexpr explicit Colormap(uint8_t built_in) noexcept : built_in_(built_in) {}

    std::shared_ptr<const std::vector<Rgb8>> colors_;  ///< none: a built-in map
    uint8_t built_in_ = 0;                             ///< its place in the order above
    bool is_reversed_ = false;                         ///< of a built-in map
};

inline constinit const Colormap Colormap::viridis{uint8_t(0)}, Colormap::plasma{uint8_t(1)},
    Colormap::inferno{uint8_t(2)}, Colormap::magma{uint8_t(3)}, Colormap::turbo{uint8_t(4)},
    Colormap::cividis{uint8_t(5)}, Colormap::grey{uint8_t(6)}, Colormap::coolwarm{uint8_t(7)};

/// The names of the built-in maps, then those of the reversed ones: "viridis_r".
const std::vector<std::string>& colormap_names();

/// A name of colormap_names(), in any case, or two or more colours (see parse_color()) with commas between
/// them: "navy,#ffffff,#800000". Throws NameError with the nearest name, ArgumentError for what is wrong with
/// a colour.
Colormap parse_colormap(std::string_view text);

/// The colours of 256 equal parts of the values, the least first.
ColorTable color_table(const Colormap& colormap);

/// So many bands of equal width, of evenly chosen colours of the map from its first to its last; the middle
/// one for a single band, and for 0 the map itself. Entries from color_parts() on repeat the last band.
/// Throws ArgumentError for less than 0 and for more than 256 bands.
ColorTable color_table(const Colormap& colormap, int steps);
/// Parts that the values are cut into: 256, or for bands the largest multiple of their number. Throws as
/// color_table() does.
int color_parts(int steps);

/// How values are spread over a colour map: themselves, or their logarithms.
enum class ColorScale { linear, log };

/// The values that a colormap is spread over. All of them, and those that the functions below take, are
/// relative to `base`, which keeps the digits of large values that lie close to each other.
struct ValueRange {
    float min = 0, max = 1;                 ///< of the first and the last colour; min < max
    float data_min = 0, data_max = 1;       ///< of all finite values that have a place on the scale
    ColorScale scale = ColorScale::linear;  ///< log: min is above 0
    int parts = 256;                        ///< of the scale, each of one colour: color_parts()
    double base = 0;                        ///< added to a value gives the true one; log: 0

    double true_min() const { return base + double(min); }
    double true_max() const { return base + double(max); }

    bool clips_below() const { return data_min < min; }
    bool clips_above() const { return data_max > max; }
};

/// 0 for the range's minimum, 1 for its maximum. NaN for NaN, and on a logarithmic scale for what is not
/// above 0.
template <class Real>
Real place_on_scale(Real value, const ValueRange& range) {
    if (range.scale == ColorScale::linear)
        return (value - Real(range.min)) / (Real(range.max) - Real(range.min));
    if (!(value > 0)) return std::numeric_limits<Real>::quiet_NaN();
    const double low = std::log10(double(range.min)), high = std::log10(double(range.max));
    return Real((std::log10(double(value)) - low) / (high - low));
}

/// Place in the table of 256 colours: the range is cut into equal parts; what is outside has the nearest
/// end's colour. -1 for what has no place. Shaders compute the same.
inline int color_index(float value, const ValueRange& range) {
    const float t = place_on_scale(value, range);
    if (std::isnan(t)) return -1;
    return t >= 1 ? range.parts - 1 : t > 0 ? int(t * float(range.parts)) : 0;
}

/// The range of finite values, on a logarithmic scale of those above 0: all of them, unless the central 98
/// percent take less than a third of it; then outliers would leave the rest hardly any colours, and the range
/// is that of the 1st to the 99th percentile (of up to 2^18 evenly chosen values). `diverging` ranges that
/// hold 0 reach as far below it as above, so that 0 has the middle colour. One single value is in the middle;
/// 0 to 1, or 1 to 10, when there is no such value. `values` are relative to `base`, which is 0 on a
/// logarithmic scale; the 0 of diverging ranges is a true one.
ValueRange automatic_range(const Array1f& values, bool diverging = false,
                           ColorScale scale = ColorScale::linear, double base = 0);

/// As far as they are given, `min` and `max`, true values, replace the automatic range's. Equal ends are the
/// middle of a range round them, as one single value is; so is an end that lies beyond all values. Throws
/// ArgumentError where `min` is above `max`, and for an end of a logarithmic scale that is not above 0.
ValueRange value_range(const Array1f& values, std::optional<float> min, std::optional<float> max,
                       bool diverging = false, ColorScale scale = ColorScale::linear, double base = 0);

}  // namespace easypbr
