#include "easypbr/app/backdrop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/output/background_image.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

constexpr size_t pixel_grain = 1 << 13;
constexpr float most_u16 = std::numeric_limits<uint16_t>::max();

Image light_over(const Image& picture, const Image& behind) {
    Image out = picture;
    float* to = out.pixels<float>().data();
    const float* from = behind.pixels<float>().data();
    parallel_for(out.pixel_count(), pixel_grain, [&](size_t i) {
        const float left = 1 - to[4 * i + 3];
        for (size_t c = 0; c < 3; ++c) to[4 * i + c] += left * from[3 * i + c];
        to[4 * i + 3] = 1;
    });
    return out;
}

/// sRGB-encoded, from 0 to 1, of a code that covers a part of what is behind it.
float mixed_code(float code, float alpha, float behind) {
    if (alpha == 0) return std::min(behind, 1.0f);
    if (alpha == 1) return code;
    const float light = alpha * linear_from_srgb(code) + (1 - alpha) * linear_from_srgb(behind);
    return srgb_from_linear(std::min(light, 1.0f));
}

template <class T>
Image codes_over(const Image& picture, const Image& behind, PixelType type) {
    Image out(picture.width(), picture.height(), 4, type);
    constexpr T most = std::numeric_limits<T>::max();
    const uint16_t* codes = picture.pixels<uint16_t>().data();
    const float* from = behind.pixels<float>().data();
    T* to = out.pixels<T>().data();
    parallel_for(out.pixel_count(), pixel_grain, [&](size_t i) {
        const float alpha = float(codes[4 * i + 3]) / most_u16;
        for (size_t c = 0; c < 3; ++c) {
            const float code = mixed_code(float(codes[4 * i + c]) / most_u16, alpha, from[3 * i + c]);
            to[4 * i + c] = T(std::lround(code * float(most)));
        }
        to[4 * i + 3] = most;
    });
    return out;
}

}  // namespace

Backdrop BackdropCache::get(const BackgroundSettings& background, const std::shared_ptr<const Image>& image,
                            Vec2i size, Encoding encoding) {
    const bool is_linear = encoding == Encoding::scene_linear;
    const bool is_kept = image_ && of_ == image && color_ == background.color && is_linear_ == is_linear &&
                         Vec2i(image_->width(), image_->height()) == size;
    if (is_kept) return {image_, encoding};
    render::BackgroundImage shown(image, background.image.empty() ? "array" : background.image);
    const Image light = shown.covering(size);
    const Vec3 color = linear_from_srgb(background.color);
    Image opaque(light.width(), light.height(), 3, PixelType::f32);
    const float* from = light.pixels<float>().data();
    float* to = opaque.pixels<float>().data();
    parallel_for(opaque.pixel_count(), pixel_grain, [&](size_t i) {
        for (size_t c = 0; c < 3; ++c) {
            const float v = from[4 * i + c] + (1 - from[4 * i + 3]) * color[Eigen::Index(c)];
            to[3 * i + c] = is_linear ? v : srgb_from_linear(std::max(v, 0.0f));
        }
    });
    of_ = image;
    color_ = background.color;
    is_linear_ = is_linear;
    image_ = std::make_shared<const Image>(std::move(opaque));
    return {image_, encoding};
}

Image over_backdrop(const Image& picture, const Backdrop& backdrop) {
    switch (backdrop.encoding) {
        case Encoding::srgb8:
            return codes_over<uint8_t>(picture, *backdrop.image, PixelType::u8);
        case Encoding::srgb16:
            return codes_over<uint16_t>(picture, *backdrop.image, PixelType::u16);
        default:
            return light_over(picture, *backdrop.image);
    }
}

}  // namespace easypbr::app
