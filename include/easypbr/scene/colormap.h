// Colormaps: from a value to one of 256 colours.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/scene/array.h"

namespace easypbr {

/// viridis, plasma, inferno, magma and cividis are perceptually uniform; turbo is a smoother rainbow; grey is
/// black to white in sRGB; coolwarm diverges from a light grey (Moreland 2009, "Diverging Color Maps for
/// Scientific Visualization").
enum class Colormap { viridis, plasma, inferno, magma, turbo, cividis, grey, coolwarm };

const std::vector<std::string>& colormap_names();
/// Throws NameError with the nearest name.
Colormap colormap_named(const std::string& name);

using ColorTable = std::array<Rgb8, 256>;
const ColorTable& color_table(Colormap colormap);

/// The values that a colormap is spread over.
struct ValueRange {
    float min = 0, max = 1;            ///< of the first and the last colour; min < max
    float data_min = 0, data_max = 1;  ///< of all finite values

    bool clips_below() const { return data_min < min; }
    bool clips_above() const { return data_max > max; }
};

/// Place in the table of 256 colours: the range is cut into 256 equal parts; what is outside has the nearest
/// end's colour. -1 for NaN. Shaders compute the same.
inline int color_index(float value, const ValueRange& range) {
    if (std::isnan(value)) return -1;
    const float t = (value - range.min) / (range.max - range.min);
    return t >= 1 ? 255 : t > 0 ? int(t * 256) : 0;
}

/// The range of finite values: all of them, unless the central 98 percent take less than a third of it; then
/// outliers would leave the rest hardly any colours, and the range is that of the 1st to the 99th percentile
/// (of up to 2^18 evenly chosen values). `diverging` ranges that hold 0 reach as far below it as above, so
/// that 0 has the middle colour. One single value is in the middle; 0 to 1 when there is no finite value.
ValueRange automatic_range(const Array1f& values, bool diverging = false);

/// As far as they are given, `min` and `max` replace the automatic range's. Throws ArgumentError when the
/// result is empty.
ValueRange value_range(const Array1f& values, std::optional<float> min, std::optional<float> max,
                       bool diverging = false);

}  // namespace easypbr
