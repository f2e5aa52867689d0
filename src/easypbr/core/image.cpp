#include "easypbr/core/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"

namespace easypbr {
namespace {

constexpr size_t pixel_grain = 1 << 14;

bool is_alpha(int channel, int channels) {
    return channels % 2 == 0 && channel == channels - 1;
}

template <class T>
T opaque_value() {
    if constexpr (std::is_same_v<T, float>) return 1.0f;
    return std::numeric_limits<T>::max();
}

template <class T>
Image convert_channels(const Image& image, int channels) {
    Image out(image.width(), image.height(), channels, image.type());
    const int from = image.channels();
    const T* in = image.pixels<T>().data();
    T* to = out.pixels<T>().data();
    const bool grey = from <= 2;
    parallel_for(image.pixel_count(), pixel_grain, [&](size_t i) {
        const T* p = in + i * from;
        for (int c = 0; c < channels; ++c) {
            T& value = to[i * channels + c];
            if (is_alpha(c, channels))
                value = from % 2 == 0 ? p[from - 1] : opaque_value<T>();
            else
                value = grey ? p[0] : p[std::min(c, from - 1)];
        }
    });
    return out;
}

/// Whether there is no alpha below a value.
template <class T>
bool has_alpha_from(const Image& image, T least) {
    const size_t channels = size_t(image.channels());
    if (channels % 2 != 0) return true;
    const auto values = image.pixels<T>();
    for (size_t i = channels - 1; i < values.size(); i += channels)
        if (!(values[i] >= least)) return false;
    return true;
}

/// `encoded` gives the number from 0 to 1 that is stored for an f32 value in [0, 1], by its place among all
/// values.
template <class Encoded>
Image u8_of(const Image& image, Encoded&& encoded) {
    if (image.type() == PixelType::u8) return image;
    Image out(image.width(), image.height(), image.channels(), PixelType::u8);
    uint8_t* to = out.pixels<uint8_t>().data();
    const size_t count = out.pixels<uint8_t>().size();
    if (image.type() == PixelType::u16) {
        const uint16_t* in = image.pixels<uint16_t>().data();
        parallel_for(count, pixel_grain,
                     [&](size_t i) { to[i] = uint8_t((in[i] * 255u + 32767u) / 65535u); });
        return out;
    }
    const float* in = image.pixels<float>().data();
    parallel_for(count, pixel_grain, [&](size_t i) {
        const float v = in[i] > 0 ? std::min(in[i], 1.0f) : 0.0f;
        to[i] = uint8_t(std::lround(encoded(v, i) * 255.0f));
    });
    return out;
}

/// Colour times a function of alpha.
template <class Scale>
Image with_scaled_color(const Image& image, Scale&& scale) {
    Image out = image;
    float* values = out.pixels<float>().data();
    const size_t channels = size_t(image.channels());
    if (channels % 2 != 0) return out;
    parallel_for(image.pixel_count(), pixel_grain, [&](size_t i) {
        float* p = values + i * channels;
        const float factor = scale(p[channels - 1]);
        for (size_t c = 0; c + 1 < channels; ++c) p[c] *= factor;
    });
    return out;
}

}  // namespace

Image::Image(int width, int height, int channels, PixelType type)
    : width_(width), height_(height), channels_(channels), type_(type) {
    if (width < 1 || height < 1 || width > max_image_side || height > max_image_side)
        throw ArgumentError(
            fmt::format("image size {}x{}: width and height must be 1 to {}", width, height, max_image_side));
    if (channels < 1 || channels > 4)
        throw ArgumentError(fmt::format("image with {} channels: expected 1 to 4", channels));
    data_.resize(row_bytes() * size_t(height));
}

Image with_channels(const Image& image, int channels) {
    if (image.channels() == channels) return image;
    switch (image.type()) {
        case PixelType::u8:
            return convert_channels<uint8_t>(image, channels);
        case PixelType::u16:
            return convert_channels<uint16_t>(image, channels);
        default:
            return convert_channels<float>(image, channels);
    }
}

Image to_u8(const Image& image) {
    return u8_of(image, [channels = size_t(image.channels())](float v, size_t i) {
        return is_alpha(int(i % channels), int(channels)) ? v : srgb_from_linear(v);
    });
}

Image data_to_u8(const Image& image) {
    return u8_of(image, [](float v, size_t) { return v; });
}

Image texels_to_u8(const Image& image, bool is_color) {
    return is_color ? to_u8(image) : data_to_u8(image);
}

Image to_linear_f32(const Image& image) {
    if (image.type() == PixelType::f32) return image;
    Image out(image.width(), image.height(), image.channels(), PixelType::f32);
    float* to = out.pixels<float>().data();
    const int channels = image.channels();
    const size_t count = image.pixel_count() * channels;
    parallel_for(count, pixel_grain, [&](size_t i) {
        const bool alpha = is_alpha(int(i % channels), channels);
        if (image.type() == PixelType::u8) {
            const uint8_t v = image.pixels<uint8_t>()[i];
            to[i] = alpha ? float(v) / 255.0f : srgb8_table()[v];
        } else {
            const float v = float(image.pixels<uint16_t>()[i]) / 65535.0f;
            to[i] = alpha ? v : linear_from_srgb(v);
        }
    });
    return out;
}

bool is_fully_opaque(const Image& image) {
    switch (image.type()) {
        case PixelType::u8:
            return has_alpha_from<uint8_t>(image, 255);
        case PixelType::u16:
            return has_alpha_from<uint16_t>(image, 65535);
        default:
            return has_alpha_from<float>(image, 1 - 0.5f / 255);
    }
}

Image unpremultiplied(const Image& image) {
    return with_scaled_color(image, [](float alpha) { return alpha > 0 ? 1 / alpha : 0.0f; });
}

Image premultiplied(const Image& image) {
    return with_scaled_color(image, [](float alpha) { return alpha; });
}

Image picture_to_u8(const Image& picture) {
    return to_u8(picture.type() == PixelType::f32 ? unpremultiplied(picture) : picture);
}

Image picture_to_linear_f32(const Image& picture) {
    return picture.type() == PixelType::f32 ? picture : premultiplied(to_linear_f32(picture));
}

float largest_color(const Image& image) {
    const size_t channels = size_t(image.channels()), colors = channels - size_t(has_alpha(image));
    const float* values = image.pixels<float>().data();
    std::atomic<float> largest = 0;
    parallel_chunks(image.pixel_count(), size_t(1) << 16, [&](size_t begin, size_t end) {
        float own = 0;
        for (size_t i = begin; i < end; ++i)
            for (size_t c = 0; c < colors; ++c) own = std::max(own, values[i * channels + c]);
        float seen = largest;
        while (seen < own && !largest.compare_exchange_weak(seen, own)) {
        }
    });
    return largest;
}

size_t replace_non_finite(Image& image) {
    if (image.type() != PixelType::f32) return 0;
    const auto values = image.pixels<float>();
    std::atomic<size_t> replaced = 0;
    parallel_chunks(values.size(), size_t(1) << 18, [&](size_t begin, size_t end) {
        size_t count = 0;
        for (size_t i = begin; i < end; ++i)
            if (!std::isfinite(values[i])) values[i] = 0, ++count;
        replaced += count;
    });
    return replaced;
}

Image half_size(const Image& image) {
    if (image.type() != PixelType::f32)
        throw ArgumentError(fmt::format("half_size: expected an image of 32 bits per channel, got {} bits",
                                        8 * size_of(image.type())));
    Image out(std::max(1, image.width() / 2), std::max(1, image.height() / 2), image.channels(),
              PixelType::f32);
    const int channels = image.channels();
    parallel_for(size_t(out.height()), 16, [&](size_t row) {
        const int y0 = int(row) * 2, y1 = std::min(y0 + 1, image.height() - 1);
        for (int x = 0; x < out.width(); ++x) {
            const int x0 = x * 2, x1 = std::min(x0 + 1, image.width() - 1);
            for (int c = 0; c < channels; ++c)
                out.at<float>(x, int(row))[c] =
                    0.25f * (image.at<float>(x0, y0)[c] + image.at<float>(x1, y0)[c] +
                             image.at<float>(x0, y1)[c] + image.at<float>(x1, y1)[c]);
        }
    });
    return out;
}

}  // namespace easypbr
