#include "easypbr/gpu/texture_cache.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

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

native::Texture::Wrap host_wrapping(Wrap wrap) {
    return wrap == Wrap::repeat   ? native::Texture::Wrap::repeat
           : wrap == Wrap::mirror ? native::Texture::Wrap::mirror
                                  : native::Texture::Wrap::clamp;
}

/// Pixels of four channels of type T, as native::Texture has a level.
template <class T>
void append_level(const std::vector<T>& pixels, int width, Wrap wrap, std::vector<std::byte>& to) {
    const size_t row = 4 * size_t(width), rows = pixels.size() / row, bytes = (row + 4) * sizeof(T);
    const size_t before = to.size();
    to.resize(before + rows * bytes);
    parallel_for(rows, 32, [&](size_t y) {
        const T* from = pixels.data() + y * row;
        std::byte* line = to.data() + before + y * bytes;
        std::memcpy(line, from, row * sizeof(T));
        std::memcpy(line + row * sizeof(T), wrap == Wrap::repeat ? from : from + row - 4, 4 * sizeof(T));
    });
}

/// Every 2x2 pixels averaged.
template <class T>
std::vector<T> smaller_level(const std::vector<T>& pixels, int width, int height) {
    const int w = std::max(1, width / 2), h = std::max(1, height / 2);
    std::vector<T> out(4 * size_t(w) * size_t(h));
    parallel_for(size_t(h), 32, [&](size_t row) {
        const size_t y0 = row * 2, y1 = std::min(y0 + 1, size_t(height) - 1);
        for (size_t x = 0; x < size_t(w); ++x) {
            const size_t x0 = 2 * x, x1 = std::min(x0 + 1, size_t(width) - 1);
            const auto at = [&](size_t column, size_t line) {
                return pixels.data() + 4 * (line * size_t(width) + column);
            };
            const T* from[4] = {at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)};
            for (size_t c = 0; c < 4; ++c)
                out[4 * (row * size_t(w) + x) + c] =
                    T((uint32_t(from[0][c]) + from[1][c] + from[2][c] + from[3][c] + 2) / 4);
        }
    });
    return out;
}

template <class T>
std::vector<std::byte> all_levels(std::vector<T> pixels, Wrap wrap, native::Texture& to) {
    std::vector<std::byte> texels;
    texels.reserve(pixels.size() * sizeof(T) * 4 / 3 + size_t(to.width + to.height) * 8 * sizeof(T));
    int width = to.width, height = to.height;
    for (int i = 0; i < to.levels; ++i) {
        to.offsets[i] = int(texels.size() / (4 * sizeof(T)));
        append_level(pixels, width, wrap, texels);
        if (i + 1 < to.levels) pixels = smaller_level(pixels, width, height);
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
    }
    texels.resize(texels.size() + 4 * sizeof(T));  // pairs of texels are read at the last one too
    return texels;
}

/// Linear light in 16 bits: an error below 0.03 of an sRGB code.
std::vector<uint16_t> linear_pixels(std::span<const uint8_t> codes) {
    std::array<uint16_t, 256> decoded;
    for (size_t i = 0; i < 256; ++i) decoded[i] = uint16_t(std::lround(srgb8_table()[i] * 65535.0f));
    std::vector<uint16_t> pixels(codes.size());
    parallel_for(codes.size() / 4, size_t(1) << 16, [&](size_t i) {
        for (size_t c = 0; c < 3; ++c) pixels[4 * i + c] = decoded[codes[4 * i + c]];
        pixels[4 * i + 3] = uint16_t(codes[4 * i + 3] * 257);
    });
    return pixels;
}

/// Fills in what does not depend on where the texels are.
std::vector<std::byte> host_texels(const Texture& texture, bool color, native::Texture& to) {
    Image image = to_valid_u8(*texture.image, texture.path);
    while (std::max(image.width(), image.height()) > 1 << (native::Texture::most_levels - 1))
        image = next_level(image, color);
    if (image.channels() < 4) image = with_channels(image, 4);
    to.width = image.width();
    to.height = image.height();
    to.levels = gl::full_levels(to.width, to.height);
    to.wrap_u = host_wrapping(texture.wrap_u);
    to.wrap_v = host_wrapping(texture.wrap_v);
    to.nearest = texture.filter == Filter::nearest;
    to.is_16_bit = color;
    const auto pixels = image.pixels<uint8_t>();
    if (color) return all_levels(linear_pixels(pixels), texture.wrap_u, to);
    return all_levels(std::vector<uint8_t>(pixels.begin(), pixels.end()), texture.wrap_u, to);
}

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

}  // namespace

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

const native::Texture& TextureCache::host(const Texture& texture, bool color) {
    const Key key{texture.image.get(), color, texture.wrap_u, texture.wrap_v, texture.filter};
    const auto make = [&] {
        HostEntry entry{texture.image, {}, {}};
        entry.texels = host_texels(texture, color, entry.texture);
        entry.texture.texels = entry.texels.data();
        return entry;
    };
    return host_entries_.get(key, make).texture;
}

}  // namespace easypbr::gpu
