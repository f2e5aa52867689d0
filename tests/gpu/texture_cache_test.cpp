// Material images in host memory: channels, decoding, mip levels and the texel beyond each row.
#include "easypbr/gpu/texture_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "easypbr/core/color.h"

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
                    const native::Texture& host = cache.host(texture, color);
                    EXPECT_EQ(host.is_16_bit, color);
                    check(host, first_level(*image, color), wrap);
                }
}

}  // namespace
}  // namespace easypbr::gpu::texture_cache_test
