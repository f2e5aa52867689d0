#include "easypbr/app/canvas.h"

#include <algorithm>
#include <limits>

namespace easypbr::app {
namespace {

/// Rec. 709 weights.
float luma(const Vec3& c) {
    return 0.2126f * c.x() + 0.7152f * c.y() + 0.0722f * c.z();
}

template <class T>
constexpr float largest = std::is_floating_point_v<T> ? 1.0f : float(std::numeric_limits<T>::max());

/// What a pixel looks like on white paper, sRGB-encoded.
template <class T>
Vec3 seen(const T* pixel) {
    const Vec3 color = Vec3(float(pixel[0]), float(pixel[1]), float(pixel[2])) / largest<T>;
    const float alpha = std::clamp(float(pixel[3]) / largest<T>, 0.0f, 1.0f), paper = 1 - alpha;
    if constexpr (std::is_floating_point_v<T>)
        return srgb_from_linear(Vec3((color.array() + paper).cwiseMax(0).cwiseMin(1)));
    else
        return (color.array() * alpha + paper).matrix();
}

/// A number in [0, 1] as a channel.
template <class T>
T channel(float value) {
    if constexpr (std::is_floating_point_v<T>) return value;
    const float code = value * largest<T> + 0.5f;
    return T(code);
}

}  // namespace

template <class T>
void Canvas::blend_pixel(T* pixel, const Rgb8& color, float alpha) const {
    const bool premultiplied = std::is_floating_point_v<T>;
    const float below = float(pixel[3]) / largest<T> * (1 - alpha), total = alpha + below;
    if (total <= 0) return;
    for (size_t c = 0; c < 3; ++c) {
        const float own = premultiplied ? srgb8_table()[color[c]] : float(color[c]) / 255;
        const float there = float(pixel[c]) / largest<T>;
        const float mixed =
            premultiplied ? own * alpha + there * (1 - alpha) : (own * alpha + there * below) / total;
        pixel[c] = channel<T>(mixed);
    }
    pixel[3] = channel<T>(total);
}

void Canvas::blend(int x, int y, const Rgb8& color, float alpha) {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return;
    switch (picture_.type()) {
        case PixelType::u8:
            return blend_pixel(picture_.at<uint8_t>(x, y), color, alpha);
        case PixelType::u16:
            return blend_pixel(picture_.at<uint16_t>(x, y), color, alpha);
        case PixelType::f32:
            return blend_pixel(picture_.at<float>(x, y), color, alpha);
    }
}

PixelRect Canvas::clipped(const PixelRect& rect) const {
    const int left = std::max(rect.x, 0), top = std::max(rect.y, 0);
    const int right = std::min(rect.x + rect.width, width()),
              bottom = std::min(rect.y + rect.height, height());
    return {left, top, std::max(0, right - left), std::max(0, bottom - top)};
}

void Canvas::fill(const PixelRect& rect, const Rgb8& color, float alpha) {
    const PixelRect inside = clipped(rect);
    for (int y = inside.y; y < inside.y + inside.height; ++y)
        for (int x = inside.x; x < inside.x + inside.width; ++x) blend(x, y, color, alpha);
}

float Canvas::brightness(const PixelRect& rect) const {
    const PixelRect inside = clipped(rect);
    double sum = 0;
    for (int y = inside.y; y < inside.y + inside.height; ++y)
        for (int x = inside.x; x < inside.x + inside.width; ++x)
            sum += luma(picture_.type() == PixelType::u8    ? seen(picture_.at<uint8_t>(x, y))
                        : picture_.type() == PixelType::u16 ? seen(picture_.at<uint16_t>(x, y))
                                                            : seen(picture_.at<float>(x, y)));
    const double count = double(inside.width) * inside.height;
    return count > 0 ? float(sum / count) : 0;
}

}  // namespace easypbr::app
