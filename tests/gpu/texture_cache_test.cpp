// Material images in host memory: channels, decoding, mip levels and the texel beyond each row.
#include "easypbr/gpu/texture_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/core/log.h"

namespace easypbr::gpu::texture_cache_test {
namespace {

/// Texels of four channels, row by row.
struct Level {
    int width, height;
    std::vector<uint32_t> values;

    uint32_t at(int x, int y, int channel) const { return values[size_t(4 * (y * width + x) + channel)]; }
};

/// The largest level, by the image's own functions.
Level first_level(const Image& image, bool color) {
    const Image four = with_channels(image, 4);
    Level level{image.width(), image.height(), {}};
    for (size_t i = 0; i < four.pixels<uint8_t>().size(); ++i) {
        const uint8_t code = four.pixels<uint8_t>()[i];
        if (!color)
            level.values.push_back(code);
        else if (i % 4 == 3)
            level.values.push_back(code * 257u);
        else
            level.values.push_back(uint32_t(std::lround(linear_from_srgb(float(code) / 255) * 65535)));
    }
    return level;
}

Level smaller(const Level& from) {
    Level level{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x)
            for (int c = 0; c < 4; ++c) {
                const int right = std::min(2 * x + 1, from.width - 1),
                          below = std::min(2 * y + 1, from.height - 1);
                level.values.push_back((from.at(2 * x, 2 * y, c) + from.at(right, 2 * y, c) +
                                        from.at(2 * x, below, c) + from.at(right, below, c) + 2) /
                                       4);
            }
    return level;
}

uint32_t texel(const native::Texture& texture, int level, int width, int x, int y, int channel) {
    const size_t i = 4 * size_t(texture.offsets[level] + y * (width + 1) + x) + size_t(channel);
    return texture.is_16_bit ? reinterpret_cast<const uint16_t*>(texture.texels)[i]
                             : uint32_t(reinterpret_cast<const uint8_t*>(texture.texels)[i]);
}

/// Whether all levels are as large and hold what they should.
void check(const native::Texture& texture, Level level, Wrap wrap) {
    for (int i = 0; i < texture.levels; ++i) {
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x <= level.width; ++x)
                for (int c = 0; c < 4; ++c) {
                    const int column = x < level.width ? x : wrap == Wrap::repeat ? 0 : level.width - 1;
                    ASSERT_EQ(texel(texture, i, level.width, x, y, c), level.at(column, y, c))
                        << "level " << i << ", " << x << " " << y << ", channel " << c;
                }
        if (i + 1 < texture.levels) level = smaller(level);
    }
    EXPECT_EQ(level.width, 1);
    EXPECT_EQ(level.height, 1);
}

TEST(HostTextures, HoldAllLevelsOfAllChannels) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 7), std::pair(5, 3), std::pair(64, 33)})
        for (int channels = 1; channels <= 4; ++channels)
            for (const bool color : {false, true})
                for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
                    auto image = std::make_shared<Image>(width, height, channels, PixelType::u8);
                    for (size_t i = 0; i < image->pixels<uint8_t>().size(); ++i)
                        image->pixels<uint8_t>()[i] = uint8_t(i * 77 + i / 5);
                    Texture texture;
                    texture.image = image;
                    texture.wrap_u = wrap;
                    TextureCache cache;
                    SCOPED_TRACE(testing::Message() << width << " x " << height << " x " << channels
                                                    << (color ? ", colour" : ", data"));
                    const native::Texture& host =
                        cache.host(texture, color ? TexelKind::color : TexelKind::data);
                    EXPECT_EQ(host.is_16_bit, color);
                    check(host, first_level(*image, color), wrap);
                }
}

/// Green of which every second column is there; black that alpha hides between.
std::shared_ptr<Image> columns(uint8_t hidden_red) {
    auto image = std::make_shared<Image>(8, 4, 4, PixelType::u8);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            uint8_t* texel = image->at<uint8_t>(x, y);
            if (x % 2 == 0) {
                texel[1] = texel[3] = 255;
            } else {
                texel[0] = hidden_red;
            }
        }
    return image;
}

// What alpha hides has no part in any level, and where it is interpolated it has the colour around. The
// coverage is averaged as it is.
TEST(HostTextures, HiddenColorsDoNotShowAtOtherLevels) {
    Texture texture;
    texture.image = columns(255);
    TextureCache cache;
    const native::Texture& host = cache.host(texture, TexelKind::covering_color);
    for (int level = 0, width = 8; level < host.levels; ++level, width = std::max(1, width / 2))
        for (int y = 0; y < std::max(1, 4 >> level); ++y)
            for (int x = 0; x <= width; ++x) {
                const auto channel = [&](int c) { return texel(host, level, width, x, y, c); };
                EXPECT_EQ(channel(0), 0u) << level;
                EXPECT_EQ(channel(1), 65535u) << level;
                EXPECT_EQ(channel(2), 0u) << level;
                EXPECT_EQ(channel(3), level > 0 ? 32768u : x % 2 == 0 ? 65535u : 0u) << level;
            }
    // Where nothing is hidden all of them count.
    const native::Texture& opaque = cache.host(texture, TexelKind::color);
    EXPECT_EQ(texel(opaque, 1, 4, 0, 0, 0), 32768u);
    EXPECT_EQ(texel(opaque, 1, 4, 0, 0, 1), 32768u);
}

// Partial alpha is a weight: three quarters of a third and a quarter of all are equal parts.
TEST(HostTextures, AlphaWeighsColors) {
    auto image = std::make_shared<Image>(2, 2, 4, PixelType::u8);
    for (int i = 0; i < 4; ++i) {
        uint8_t* texel = image->at<uint8_t>(i % 2, i / 2);
        texel[i < 3 ? 0 : 1] = 255;
        texel[3] = i < 3 ? 85 : 255;
    }
    Texture texture;
    texture.image = image;
    TextureCache cache;
    const native::Texture& host = cache.host(texture, TexelKind::covering_color);
    EXPECT_EQ(texel(host, 1, 1, 0, 0, 0), 32768u);
    EXPECT_EQ(texel(host, 1, 1, 0, 0, 1), 32768u);
    EXPECT_EQ(texel(host, 1, 1, 0, 0, 3), 32768u);
}

/// One texel of two channels, grey and alpha.
template <class T>
Texture grey_texture(PixelType type, T grey, T alpha) {
    auto image = std::make_shared<Image>(1, 1, 2, type);
    image->template at<T>(0, 0)[0] = grey;
    image->template at<T>(0, 0)[1] = alpha;
    Texture texture;
    texture.image = std::move(image);
    return texture;
}

// Data is a number, whatever its type: code 128 is 128 * 257 of 16 bits. Colours of floats are light: half of
// it is code 188 (255 * 0.73536 = 187.52), which is decoded again; their alpha has no curve.
TEST(HostTextures, TypesOfTexelsHoldTheSame) {
    const Texture textures[] = {grey_texture<uint8_t>(PixelType::u8, 128, 128),
                                grey_texture<uint16_t>(PixelType::u16, 128 * 257, 128 * 257),
                                grey_texture<float>(PixelType::f32, 0.5f, 0.5f)};
    for (const Texture& texture : textures) {
        TextureCache cache;
        const native::Texture& host = cache.host(texture, TexelKind::data);
        EXPECT_EQ(texel(host, 0, 1, 0, 0, 0), 128u) << int(texture.image->type());
        EXPECT_EQ(texel(host, 0, 1, 0, 0, 3), 128u) << int(texture.image->type());
    }
    TextureCache cache;
    const native::Texture& light = cache.host(textures[2], TexelKind::color);
    EXPECT_EQ(texel(light, 0, 1, 0, 0, 0), uint32_t(std::lround(linear_from_srgb(188 / 255.0f) * 65535)));
    EXPECT_EQ(texel(light, 0, 1, 0, 0, 3), 128 * 257u);
}

/// What is said while textures are made.
std::string warnings_of(const std::function<void()>& make) {
    std::string text;
    set_log_sink([&](LogLevel, std::string_view message) { text += std::string(message) + "\n"; });
    make();
    set_log_sink({});
    return text;
}

// Of colours alone, not of alpha, once, with what holds them and the largest.
TEST(HostTextures, ColorsAboveOneAreAWarning) {
    Texture bright = grey_texture<float>(PixelType::f32, 7.5f, 1), covering = bright;
    covering.image = grey_texture<float>(PixelType::f32, 1, 9).image;
    const Texture codes = grey_texture<uint8_t>(PixelType::u8, 255, 255);
    TextureCache cache;
    EXPECT_EQ(warnings_of([&] {
                  for (int i = 0; i < 2; ++i) cache.host(bright, TexelKind::color, "emissive_texture");
              }),
              "emissive_texture: colours above 1 were clamped to 1, the largest value is 7.5\n");
    EXPECT_EQ(warnings_of([&] {
                  cache.host(bright, TexelKind::data, "roughness_texture");
                  cache.host(covering, TexelKind::covering_color, "base_color_texture");
                  cache.host(codes, TexelKind::color, "base_color_texture");
              }),
              "");
    bright.image = grey_texture<float>(PixelType::f32, 2, 1).image;
    bright.path = "sun.exr";
    EXPECT_EQ(warnings_of([&] { cache.host(bright, TexelKind::color, "emissive_texture"); }),
              "emissive_texture 'sun.exr': colours above 1 were clamped to 1, the largest value is 2\n");
}

}  // namespace
}  // namespace easypbr::gpu::texture_cache_test
