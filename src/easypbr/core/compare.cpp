#include "easypbr/core/image.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace easypbr {
namespace {

template <class T>
ImageDifference compare_as(const Image& a, const Image& b, double peak) {
    const auto p = a.pixels<T>(), q = b.pixels<T>();
    ImageDifference result;
    double sum = 0, squares = 0;
    bool differs = false;
    for (size_t i = 0; i < p.size(); ++i) {
        // Equal bits are equal, infinities included; a NaN on one side only is an infinite difference.
        double d = p[i] == q[i] ? 0.0 : std::abs(double(p[i]) - double(q[i]));
        if (std::isnan(d)) d = std::isnan(double(p[i])) && std::isnan(double(q[i])) ? 0.0 : INFINITY;
        sum += d, squares += d * d;
        result.max = std::max(result.max, d);
        differs |= d > 0;
        if ((i + 1) % size_t(a.channels()) == 0) result.different += differs, differs = false;
    }
    const double count = double(p.size());
    result.mean = sum / count;
    result.rmse = std::sqrt(squares / count);
    result.psnr =
        squares > 0 ? 20.0 * std::log10(peak / result.rmse) : std::numeric_limits<double>::infinity();
    return result;
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b) {
    if (a.width() != b.width() || a.height() != b.height() || a.channels() != b.channels() ||
        a.type() != b.type())
        throw ArgumentError(
            fmt::format("images differ in kind: {}x{} with {} channels of {} bytes and {}x{} with {} "
                        "channels of {} bytes",
                        a.width(), a.height(), a.channels(), size_of(a.type()), b.width(), b.height(),
                        b.channels(), size_of(b.type())));
    switch (a.type()) {
        case PixelType::u8:
            return compare_as<uint8_t>(a, b, 255);
        case PixelType::u16:
            return compare_as<uint16_t>(a, b, 65535);
        default:
            return compare_as<float>(a, b, 1);
    }
}

}  // namespace easypbr
