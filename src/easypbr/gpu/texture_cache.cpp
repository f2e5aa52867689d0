#include "easypbr/gpu/texture_cache.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/gl/context.h"

namespace easypbr::gpu {
namespace {

/// sRGB codes of 4096 linear values: mip levels average light, not codes.
const std::array<uint8_t, 4096>& encode_table() {
    static const std::array<uint8_t, 4096> table = [] {
        std::array<uint8_t, 4096> codes{};
        for (int i = 0; i < 4096; ++i)
            codes[size_t(i)] = uint8_t(std::lround(srgb_from_linear(float(i) / 4095.0f) * 255.0f));
        return codes;
    }();
    return table;
}

/// Every 2x2 pixels of a u8 image averaged; the first three channels as light when they are colour.
Image next_level(const Image& image, bool color) {
    const int channels = image.channels();
    Image out(std::max(1, image.width() / 2), std::max(1, image.height() / 2), channels, PixelType::u8);
    const float* decode = srgb8_table();
    const auto& encode = encode_table();
    parallel_for(size_t(out.height()), 32, [&](size_t row) {
        const int y0 = int(row) * 2, y1 = std::min(y0 + 1, image.height() - 1);
        for (int x = 0; x < out.width(); ++x) {
            const int x0 = 2 * x, x1 = std::min(x0 + 1, image.width() - 1);
            const uint8_t* p[4] = {image.at<uint8_t>(x0, y0), image.at<uint8_t>(x1, y0),
                                   image.at<uint8_t>(x0, y1), image.at<uint8_t>(x1, y1)};
            uint8_t* to = out.at<uint8_t>(x, int(row));
            for (int c = 0; c < channels; ++c) {
                if (color && c < 3) {
                    const float sum = decode[p[0][c]] + decode[p[1][c]] + decode[p[2][c]] + decode[p[3][c]];
                    const float code = sum * (4095.0f / 4) + 0.5f;
                    to[c] = encode[size_t(code)];
                } else {
                    to[c] = uint8_t((p[0][c] + p[1][c] + p[2][c] + p[3][c] + 2) / 4);
                }
            }
        }
    });
    return out;
}

gl::Wrapping wrapping(Wrap wrap) {
    return wrap == Wrap::repeat   ? gl::Wrapping::repeat
           : wrap == Wrap::mirror ? gl::Wrapping::mirror
                                  : gl::Wrapping::clamp;
}

/// The image as u8, without values that are no numbers.
Image to_valid_u8(const Image& image, const std::string& name) {
    if (image.type() != PixelType::f32) return to_u8(image);
    Image valid = image;
    if (const size_t replaced = replace_non_finite(valid))
        log_warning(fmt::format("texture '{}': {} values that are NaN or infinite were replaced by 0", name,
                                replaced));
    return to_u8(valid);
}

}  // namespace

gl::Texture make_texture(const Image& image, bool color, const std::string& name) {
    // Three channels are uploaded as they are; grey and grey with alpha are spread to four.
    Image level = to_valid_u8(image, name);
    if (level.channels() < 3) level = with_channels(level, 4);
    // A texture larger than the driver takes is drawn at half the resolution, or less.
    while (std::max(level.width(), level.height()) > gl::Context::current().info().max_texture_size)
        level = next_level(level, color);
    const int levels = gl::full_levels(level.width(), level.height());
    gl::Texture texture(color ? gl::Format::srgb8_alpha8 : gl::Format::rgba8, level.width(), level.height(),
                        levels);
    for (int i = 0; i < levels; ++i) {
        texture.upload_u8(level.bytes(), level.channels(), i);
        if (i + 1 < levels) level = next_level(level, color);
    }
    texture.sampling(gl::Filtering::trilinear);
    return texture;
}

const gl::Texture& TextureCache::get(const Texture& texture, bool color) {
    const Key key{texture.image.get(), color, texture.wrap_u, texture.wrap_v, texture.filter};
    const auto make = [&] {
        Entry entry{texture.image, make_texture(*texture.image, color, texture.path)};
        // Anisotropic filtering is cheap on a GPU and costs several times the fetch on a CPU rasteriser.
        const float anisotropy = gl::Context::current().info().software ? 1.0f : 8.0f;
        entry.texture.sampling(
            texture.filter == Filter::nearest ? gl::Filtering::nearest : gl::Filtering::trilinear,
            wrapping(texture.wrap_u), wrapping(texture.wrap_v), anisotropy);
        return entry;
    };
    return entries_.get(key, make).texture;
}

}  // namespace easypbr::gpu
