// Pictures that are shaded natively beside those of the driver.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "easypbr/core/image.h"

namespace easypbr::native_shading_test {

/// Pixels by how far apart their largest channels are.
struct Difference {
    size_t pixels = 0, by_one = 0, by_more = 0;
    int most = 0;
};

/// A channel, colours as much as they cover: where nothing is to be seen they mean nothing.
inline int seen(const Image& picture, size_t pixel, size_t channel) {
    const uint8_t* p = picture.pixels<uint8_t>().data() + 4 * pixel;
    return channel == 3 ? p[3] : (p[channel] * p[3] + 127) / 255;
}

inline Difference difference(const Image& a, const Image& b) {
    Difference d;
    d.pixels = a.pixel_count();
    for (size_t i = 0; i < a.pixel_count(); ++i) {
        int most = 0;
        for (size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(seen(a, i, c) - seen(b, i, c)));
        d.by_one += most == 1;
        d.by_more += most > 1;
        d.most = std::max(d.most, most);
    }
    return d;
}

}  // namespace easypbr::native_shading_test
