#include "easypbr/app/channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/pipeline/layers.h"
#include "easypbr/scene/colormap.h"
#include "easypbr/scene/label_colors.h"

namespace easypbr::app {
namespace {

using Pixel = std::array<uint8_t, 4>;
constexpr Pixel background = {64, 64, 64, 255};
constexpr double slant_deg = 15;

uint8_t code(float value) {
    return uint8_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

template <class ColorOf>
Image painted(const Image& layer, ColorOf&& color_of) {
    Image picture(layer.width(), layer.height(), 4, PixelType::u8);
    const int channels = layer.channels();
    const float* from = layer.pixels<float>().data();
    uint8_t* to = picture.pixels<uint8_t>().data();
    parallel_for(layer.pixel_count(), 1 << 14, [&](size_t i) {
        const Pixel pixel = color_of(from + i * size_t(channels));
        std::memcpy(to + 4 * i, pixel.data(), 4);
    });
    return picture;
}

Pixel of(const Rgb8& color) {
    return {color[0], color[1], color[2], 255};
}

/// Smallest and largest number that is not 0, which stands for nothing.
ValueRange range_of(const Image& layer) {
    ValueRange range;
    range.min = INFINITY;
    range.max = -INFINITY;
    for (const float value : layer.pixels<float>())
        if (value != 0) range.min = std::min(range.min, value), range.max = std::max(range.max, value);
    if (!(range.min < range.max)) range.max = range.min + 1;
    return range;
}

Image depth_picture(const Image& layer) {
    const ValueRange range = range_of(layer);
    const ColorTable& table = color_table(Colormap::viridis);
    // What is near is bright.
    return painted(layer, [&](const float* z) {
        return *z == 0 ? background : of(table[size_t(255 - color_index(*z, range))]);
    });
}

}  // namespace

bool is_layer(const std::string& channel) {
    return channel != "picture" && channel != "slices";
}

std::vector<std::string> channel_names() {
    std::vector<std::string> names = {"picture", "slices"};
    names.insert(names.end(), render::layer_names().begin(), render::layer_names().end());
    return names;
}

Image layer_picture(const std::string& name, const Image& layer) {
    if (name == "albedo")
        return painted(layer, [](const float* c) {
            if (c[3] == 0) return background;
            const Vec3 srgb = srgb_from_linear(Vec3(c[0], c[1], c[2]));
            return Pixel{code(srgb.x()), code(srgb.y()), code(srgb.z()), 255};
        });
    if (name == "normal_world")
        return painted(layer, [](const float* n) {
            if (n[0] == 0 && n[1] == 0 && n[2] == 0) return background;
            return Pixel{code(n[0] / 2 + 0.5f), code(n[1] / 2 + 0.5f), code(n[2] / 2 + 0.5f), 255};
        });
    if (name == "depth") return depth_picture(layer);
    if (name == "object_id" || name == "element_id") {
        const GeneratedColors colors(int32_t(range_of(layer).max));
        return painted(layer, [&](const float* id) {
            return *id == 0 ? background : of(colors.color_of(int32_t(*id)));
        });
    }
    return painted(layer, [](const float* v) { return Pixel{code(*v), code(*v), code(*v), 255}; });
}

Image slices(const std::vector<Image>& pictures) {
    if (pictures.empty()) throw ArgumentError("slices: expected at least one picture");
    const int width = pictures[0].width(), height = pictures[0].height();
    for (const Image& picture : pictures)
        if (picture.width() != width || picture.height() != height)
            throw ArgumentError("slices: expected pictures of one size");
    Image result(width, height, 4, PixelType::u8);
    const double slope = std::tan(slant_deg * pi / 180), count = double(pictures.size());
    const double line = std::max(1.0, width / 500.0);
    parallel_for(size_t(height), 8, [&](size_t row) {
        const int y = int(row);
        for (int x = 0; x < width; ++x) {
            const double across = x + 0.5 + slope * (y + 0.5 - height / 2.0);
            const double slice = across / width * count;
            const int index = std::clamp(int(std::floor(slice)), 0, int(count) - 1);
            const double border =
                std::round(std::clamp(slice, 1.0, std::max(1.0, count - 1))) / count * width;
            uint8_t* to = result.at<uint8_t>(x, y);
            std::memcpy(to, pictures[size_t(index)].at<uint8_t>(x, y), 4);
            if (count > 1 && std::abs(across - border) < line) std::memset(to, 255, 4);
        }
    });
    return result;
}

}  // namespace easypbr::app
