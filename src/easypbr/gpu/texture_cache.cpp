#include "easypbr/gpu/texture_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/gl/context.h"
#include "easypbr/scene/texture_warnings.h"

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

/// Of an image without alpha all is seen.
TexelKind kind_in(const Image& image, TexelKind kind) {
    return kind == TexelKind::covering_color && !has_alpha(image) ? TexelKind::color : kind;
}

/// The mean of four values, by weights that are not all zero.
template <class T, class Weight>
T mean_of(const std::array<T, 4>& values, const std::array<Weight, 4>& weights) {
    T sum = 0, weight = 0;
    for (size_t i = 0; i < 4; ++i) {
        sum += values[i] * T(weights[i]);
        weight += T(weights[i]);
    }
    return sum / weight;
}

/// Every 2x2 pixels of a u8 image averaged; colours as light.
Image next_level(const Image& image, TexelKind kind) {
    const int channels = image.channels();
    Image out(std::max(1, image.width() / 2), std::max(1, image.height() / 2), channels, PixelType::u8);
    const float* decode = srgb8_table();
    const auto& encode = encode_table();
    const int colors = kind == TexelKind::data ? 0 : std::min(channels - int(has_alpha(image)), 3);
    const std::array<uint8_t, 4> even{1, 1, 1, 1};
    parallel_for(size_t(out.height()), 32, [&](size_t row) {
        const int y0 = int(row) * 2, y1 = std::min(y0 + 1, image.height() - 1);
        for (int x = 0; x < out.width(); ++x) {
            const int x0 = 2 * x, x1 = std::min(x0 + 1, image.width() - 1);
            const uint8_t* p[4] = {image.at<uint8_t>(x0, y0), image.at<uint8_t>(x1, y0),
                                   image.at<uint8_t>(x0, y1), image.at<uint8_t>(x1, y1)};
            uint8_t* to = out.at<uint8_t>(x, int(row));
            std::array<uint8_t, 4> weights = even;
            if (kind == TexelKind::covering_color) {
                for (size_t i = 0; i < 4; ++i) weights[i] = p[i][channels - 1];
                if (weights == std::array<uint8_t, 4>{}) weights = even;
            }
            for (int c = 0; c < channels; ++c) {
                if (c < colors) {
                    const std::array<float, 4> light{decode[p[0][c]], decode[p[1][c]], decode[p[2][c]],
                                                     decode[p[3][c]]};
                    const float code = mean_of(light, weights) * 4095.0f + 0.5f;
                    to[c] = encode[size_t(code)];
                } else {
                    to[c] = uint8_t((p[0][c] + p[1][c] + p[2][c] + p[3][c] + 2) / 4);
                }
            }
        }
    });
    return out;
}

/// Gives pixels that alpha hides the colours of the next level, which are those around: they show where
/// pixels are interpolated.
void fill_hidden(Image& image, const Image& smaller) {
    const size_t colors = size_t(image.channels()) - 1;
    parallel_for(size_t(image.height()), 32, [&](size_t row) {
        const int y = std::min(int(row) / 2, smaller.height() - 1);
        for (int x = 0; x < image.width(); ++x) {
            uint8_t* pixel = image.at<uint8_t>(x, int(row));
            if (pixel[colors] == 0)
                std::copy_n(smaller.at<uint8_t>(std::min(x / 2, smaller.width() - 1), y), colors, pixel);
        }
    });
}

gl::Wrapping wrapping(Wrap wrap) {
    return wrap == Wrap::repeat   ? gl::Wrapping::repeat
           : wrap == Wrap::mirror ? gl::Wrapping::mirror
                                  : gl::Wrapping::clamp;
}

/// The image as u8, without values that are no numbers.
Image to_valid_u8(const Image& image, TexelKind kind, const std::string& name) {
    const bool is_color = kind != TexelKind::data;
    if (image.type() != PixelType::f32) return texels_to_u8(image, is_color);
    Image valid = image;
    if (const size_t replaced = replace_non_finite(valid))
        log_warning(fmt::format("{}: {} values that are NaN or infinite were replaced by 0", name, replaced));
    if (is_color) warn_of_clamped_colors(valid, name);
    return texels_to_u8(valid, is_color);
}

native::Texture::Wrap host_wrapping(Wrap wrap) {
    return wrap == Wrap::repeat   ? native::Texture::Wrap::repeat
           : wrap == Wrap::mirror ? native::Texture::Wrap::mirror
                                  : native::Texture::Wrap::clamp;
}

/// Linear light in 16 bits of codes: an error below 0.03 of an sRGB code.
const std::array<uint16_t, 256>& linear_table() {
    static const std::array<uint16_t, 256> table = [] {
        std::array<uint16_t, 256> values{};
        for (size_t i = 0; i < 256; ++i) values[i] = uint16_t(std::lround(srgb8_table()[i] * 65535.0f));
        return values;
    }();
    return table;
}

/// A level of a native::Texture: rows of four channels with a texel more.
template <class T>
struct HostLevel {
    T* texels;
    int width, height;

    T* row(size_t y) const { return texels + 4 * (size_t(width) + 1) * y; }
    /// The texel beyond a row's end.
    void close(T* row, Wrap wrap) const {
        const T* from = wrap == Wrap::repeat ? row : row + 4 * (size_t(width) - 1);
        std::copy_n(from, 4, row + 4 * size_t(width));
    }
};

/// Spreads the channels of an image to four, as with_channels() does. `color` and `alpha` decode codes.
template <class T, class Color, class Alpha>
void fill_level(const Image& image, Wrap wrap, const HostLevel<T>& to, Color&& color, Alpha&& alpha) {
    const size_t channels = size_t(image.channels());
    const size_t green = channels > 2 ? 1 : 0, blue = channels > 2 ? 2 : 0;
    const bool with_alpha = has_alpha(image);
    parallel_for(size_t(to.height), 32, [&](size_t y) {
        const uint8_t* p = image.at<uint8_t>(0, int(y));
        T *row = to.row(y), *q = row;
        for (int x = 0; x < to.width; ++x, p += channels, q += 4) {
            q[0] = color(p[0]);
            q[1] = color(p[green]);
            q[2] = color(p[blue]);
            q[3] = alpha(with_alpha ? p[channels - 1] : uint8_t(255));
        }
        to.close(row, wrap);
    });
}

/// The mean colour of four texels, weighted by their alpha, which must not be 0 for all.
template <class T>
void average_covered(const std::array<const T*, 4>& from, T* to) {
    std::array<T, 4> alpha;
    for (size_t i = 0; i < 4; ++i) alpha[i] = from[i][3];
    for (size_t c = 0; c < 3; ++c) {
        const std::array<double, 4> values{double(from[0][c]), double(from[1][c]), double(from[2][c]),
                                           double(from[3][c])};
        to[c] = T(std::lround(mean_of(values, alpha)));
    }
}

/// Every 2x2 texels averaged.
template <bool covering, class T>
void fill_smaller(const HostLevel<T>& from, Wrap wrap, const HostLevel<T>& to) {
    parallel_for(size_t(to.height), 32, [&](size_t y) {
        const T *upper = from.row(2 * y), *lower = from.row(std::min(2 * y + 1, size_t(from.height) - 1));
        T* row = to.row(y);
        for (size_t x = 0; x < size_t(to.width); ++x) {
            const size_t left = 8 * x, right = 4 * std::min(2 * x + 1, size_t(from.width) - 1);
            for (size_t c = 0; c < 4; ++c)
                row[4 * x + c] = T(
                    (uint32_t(upper[left + c]) + upper[right + c] + lower[left + c] + lower[right + c] + 2) /
                    4);
            if constexpr (covering) {
                const std::array<const T*, 4> four{upper + left, upper + right, lower + left, lower + right};
                const T alpha = four[0][3];
                if (std::ranges::any_of(four, [&](const T* texel) { return texel[3] != alpha; }))
                    average_covered(four, row + 4 * x);
            }
        }
        to.close(row, wrap);
    });
}

/// As fill_hidden() of images.
template <class T>
void fill_hidden(const HostLevel<T>& level, Wrap wrap, const HostLevel<T>& smaller) {
    parallel_for(size_t(level.height), 32, [&](size_t y) {
        T* row = level.row(y);
        const T* from = smaller.row(std::min(y / 2, size_t(smaller.height) - 1));
        for (size_t x = 0; x < size_t(level.width); ++x)
            if (row[4 * x + 3] == 0)
                std::copy_n(from + 4 * std::min(x / 2, size_t(smaller.width) - 1), 3, row + 4 * x);
        level.close(row, wrap);
    });
}

/// Makes room for all levels. Every texel is written once, by whoever makes it: nothing is cleared before.
template <class T>
PooledVector<std::byte> make_levels(native::Texture& to, std::vector<HostLevel<T>>& levels) {
    size_t count = 0;
    for (int i = 0; i < to.levels; ++i) {
        const int width = std::max(1, to.width >> i), height = std::max(1, to.height >> i);
        to.offsets[i] = int(count);
        levels.push_back({nullptr, width, height});
        count += size_t(width + 1) * size_t(height);
    }
    // Pairs of texels are read at the last one too.
    PooledVector<std::byte> texels((count + 1) * 4 * sizeof(T));
    T* first = reinterpret_cast<T*>(texels.data());
    for (size_t i = 0; i < levels.size(); ++i) levels[i].texels = first + 4 * size_t(to.offsets[i]);
    std::fill_n(first + 4 * count, 4, T(0));
    return texels;
}

template <bool covering, class T, class Color, class Alpha>
PooledVector<std::byte> all_levels(const Image& image, Wrap wrap, native::Texture& to, Color&& color,
                                   Alpha&& alpha) {
    std::vector<HostLevel<T>> levels;
    PooledVector<std::byte> texels = make_levels(to, levels);
    fill_level(image, wrap, levels[0], color, alpha);
    for (size_t i = 1; i < levels.size(); ++i) fill_smaller<covering>(levels[i - 1], wrap, levels[i]);
    if constexpr (covering)
        for (size_t i = levels.size() - 1; i > 0; --i) fill_hidden(levels[i - 1], wrap, levels[i]);
    return texels;
}

/// Fills in what does not depend on where the texels are.
PooledVector<std::byte> host_texels(const Texture& texture, TexelKind kind, const std::string& name,
                                    native::Texture& to) {
    const Image* image = texture.image.get();
    Image changed;
    if (image->type() != PixelType::u8) image = &(changed = to_valid_u8(*image, kind, name));
    while (std::max(image->width(), image->height()) > 1 << (native::Texture::most_levels - 1))
        image = &(changed = next_level(*image, kind));
    to.width = image->width();
    to.height = image->height();
    to.levels = gl::full_levels(to.width, to.height);
    to.wrap_u = host_wrapping(texture.wrap_u);
    to.wrap_v = host_wrapping(texture.wrap_v);
    to.nearest = texture.filter == Filter::nearest;
    to.is_16_bit = kind != TexelKind::data;
    const auto same = [](uint8_t code) { return code; };
    const auto light = [&linear = linear_table()](uint8_t code) { return linear[code]; };
    const auto alpha = [](uint8_t code) { return uint16_t(code * 257); };
    switch (kind) {
        case TexelKind::data:
            return all_levels<false, uint8_t>(*image, texture.wrap_u, to, same, same);
        case TexelKind::color:
            return all_levels<false, uint16_t>(*image, texture.wrap_u, to, light, alpha);
        case TexelKind::covering_color:
            break;
    }
    return all_levels<true, uint16_t>(*image, texture.wrap_u, to, light, alpha);
}

gl::Texture make_texture(const Image& image, TexelKind kind, const std::string& name) {
    // Three channels are uploaded as they are; grey and grey with alpha are spread to four.
    Image level = to_valid_u8(image, kind, name);
    if (level.channels() < 3) level = with_channels(level, 4);
    // A texture larger than the driver takes is drawn at half the resolution, or less.
    while (std::max(level.width(), level.height()) > gl::Context::current().info().max_texture_size)
        level = next_level(level, kind);
    const int count = gl::full_levels(level.width(), level.height());
    gl::Texture texture(kind == TexelKind::data ? gl::Format::rgba8 : gl::Format::srgb8_alpha8, level.width(),
                        level.height(), count);
    std::vector<Image> covering;  // levels that change once the next one is known
    for (int i = 0; i < count; ++i) {
        Image next = i + 1 < count ? next_level(level, kind) : Image();
        if (kind == TexelKind::covering_color)
            covering.push_back(std::move(level));
        else
            texture.upload_u8(level.bytes(), level.channels(), i);
        level = std::move(next);
    }
    for (size_t i = covering.size(); i > 0; --i) {
        if (i < covering.size()) fill_hidden(covering[i - 1], covering[i]);
        texture.upload_u8(covering[i - 1].bytes(), covering[i - 1].channels(), int(i - 1));
    }
    texture.sampling(gl::Filtering::trilinear);
    return texture;
}

}  // namespace

const gl::Texture& TextureCache::get(const Texture& texture, TexelKind kind, std::string_view slot) {
    kind = kind_in(*texture.image, kind);
    const Key key{texture.image.get(), kind, texture.wrap_u, texture.wrap_v, texture.filter};
    const auto make = [&] {
        Entry entry{texture.image, make_texture(*texture.image, kind, name_in_warning(texture, slot))};
        // Anisotropic filtering is cheap on a GPU and costs several times the fetch on a CPU rasteriser.
        const float anisotropy = gl::Context::current().info().software ? 1.0f : 8.0f;
        entry.texture.sampling(
            texture.filter == Filter::nearest ? gl::Filtering::nearest : gl::Filtering::trilinear,
            wrapping(texture.wrap_u), wrapping(texture.wrap_v), anisotropy);
        return entry;
    };
    return entries_.get(key, make).texture;
}

const native::Texture& TextureCache::host(const Texture& texture, TexelKind kind, std::string_view slot) {
    kind = kind_in(*texture.image, kind);
    const Key key{texture.image.get(), kind, texture.wrap_u, texture.wrap_v, texture.filter};
    const auto make = [&] {
        HostEntry entry{texture.image, {}, {}};
        entry.texels = host_texels(texture, kind, name_in_warning(texture, slot), entry.texture);
        entry.texture.texels = entry.texels.data();
        return entry;
    };
    return host_entries_.get(key, make).texture;
}

}  // namespace easypbr::gpu
