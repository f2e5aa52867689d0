// What numbers of colours mean: 0 to 1, or codes of 8 or 16 bits.
#pragma once

#include "easypbr/scene/array.h"

namespace easypbr {

/// The smallest and the largest of the numbers; NaN is passed over, and both are 0 where there are no others.
struct ColorRange {
    float low = 0, high = 0;
};
ColorRange range_of_colors(const ArrayXf::Dense& C);

/// What full intensity is, of colours whose type does not tell: 1 if none is as large as 2 (above 1 are sums
/// and products of colours, and what was rounded), 255 if none is larger, else 65535.
float white_of(const ColorRange& range);

/// Divides by white_of() the range of the finite numbers, in parallel; infinite ones stay as they are.
void normalize_colors(ArrayXf::Dense& C);

}  // namespace easypbr
