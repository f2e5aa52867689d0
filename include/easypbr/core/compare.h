// Comparison of two images of the same size.
#pragma once

#include "easypbr/core/image.h"

namespace easypbr {

struct ImageDifference {
    double max = 0;        ///< largest absolute difference of a channel, in units of the type (0..255 for u8)
    double mean = 0;       ///< mean absolute difference over all channels
    double rmse = 0;       ///< root of the mean squared difference
    double psnr = 0;       ///< in dB with peak 255, 65535 or 1 (infinity for equal images)
    size_t different = 0;  ///< pixels with any difference
};

/// Throws ArgumentError when size, channels or type differ. Alpha counts as any channel.
ImageDifference compare(const Image& a, const Image& b);

}  // namespace easypbr
