#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "easypbr/core/parallel.h"
#include "easypbr/gui/shown_image.h"

namespace easypbr::gui {
namespace {

constexpr Rgba8 not_a_number = {255, 0, 255, 255};
constexpr int chequer = 8;

/// A channel of any type as a float.
template <class T>
float number(const T* pixel, int channel) {
    return float(pixel[channel]);
}

uint8_t code(float t) {
    const float scaled = std::clamp(t, 0.0f, 1.0f) * 255 + 0.5f;
    return uint8_t(scaled);
}

/// A colour in front of the chequered ground; `alpha` in [0, 1].
Rgba8 over_ground(Rgba8 color, float alpha, int x, int y) {
    const float ground = (x / chequer + y / chequer) % 2 ? 0.8f : 0.6f;
    for (int c = 0; c < 3; ++c)
        color[size_t(c)] = code(alpha * float(color[size_t(c)]) / 255 + (1 - alpha) * ground);
    return color;
}

template <class T>
void fill(Image& shown, const Image& image, const ImageLook& look) {
    const ValueRange range = range_of(image, look);
    const ColorTable& table = color_table(colormap_of(image, look));
    const float full = std::is_same_v<T, float> ? 1.0f : float(std::numeric_limits<T>::max());
    parallel_for(size_t(image.height()), 16, [&](size_t row) {
        const int y = int(row);
        for (int x = 0; x < image.width(); ++x) {
            const T* from = image.at<T>(x, y);
            Rgba8 color = not_a_number;
            if (image.channels() == 1) {
                if (const int place = color_index(number(from, 0), range); place >= 0)
                    color = opaque(table[size_t(place)]);
            } else if (!std::isnan(number(from, 0) + number(from, 1) + number(from, 2))) {
                for (int c = 0; c < 3; ++c)
                    color[size_t(c)] = code((number(from, c) - range.min) / (range.max - range.min));
            }
            if (image.channels() == 4) {
                const float alpha = number(from, 3) / full;
                color = std::isnan(alpha) ? not_a_number
                                          : over_ground(color, std::clamp(alpha, 0.0f, 1.0f), x, y);
            }
            std::ranges::copy(color, shown.at<uint8_t>(x, y));
        }
    });
}

/// The range of all finite values; 0 to 1 without any.
ValueRange all_values(std::span<const float> values) {
    float low = HUGE_VALF, high = -HUGE_VALF;
    for (const float value : values)
        if (std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    if (low > high) return {};
    if (low == high) return {low - 0.5f, low + 0.5f, low, high};
    return {low, high, low, high};
}

}  // namespace

ValueRange range_of(const Image& image, const ImageLook& look) {
    ValueRange range;
    if (image.type() != PixelType::f32)
        range.max = range.data_max = image.type() == PixelType::u8 ? 255 : 65535;
    else if (image.channels() == 1)
        range = all_values(image.pixels<float>());
    range.min = look.min.value_or(range.min);
    range.max = look.max.value_or(range.max);
    // One end was given, beyond the other one.
    if (!(range.min < range.max))
        (look.min ? range.max : range.min) = look.min ? range.min + 1 : range.max - 1;
    return range;
}

Colormap colormap_of(const Image& image, const ImageLook& look) {
    return look.colormap.value_or(image.type() == PixelType::f32 ? Colormap::viridis : Colormap::grey);
}

Image shown_image(const Image& image, const ImageLook& look) {
    Image shown(image.width(), image.height(), 4, PixelType::u8);
    if (image.type() == PixelType::u8)
        fill<uint8_t>(shown, image, look);
    else if (image.type() == PixelType::u16)
        fill<uint16_t>(shown, image, look);
    else
        fill<float>(shown, image, look);
    return shown;
}

}  // namespace easypbr::gui
