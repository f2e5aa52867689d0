#include "easypbr/core/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace easypbr::image_test {

namespace {

template <class T>
Image image_of(int width, int height, int channels, PixelType type, std::initializer_list<T> values) {
    Image image(width, height, channels, type);
    std::copy(values.begin(), values.end(), image.pixels<T>().begin());
    return image;
}

template <class T>
std::vector<T> values_of(const Image& image) {
    const auto pixels = image.pixels<T>();
    return {pixels.begin(), pixels.end()};
}

}  // namespace

TEST(Image, RefusesImpossibleSizes) {
    EXPECT_THROW(Image(0, 1, 1, PixelType::u8), ArgumentError);
    EXPECT_THROW(Image(1, -1, 1, PixelType::u8), ArgumentError);
    EXPECT_THROW(Image(max_image_side + 1, 1, 1, PixelType::u8), ArgumentError);
    EXPECT_THROW(Image(1, 1, 5, PixelType::u8), ArgumentError);
    EXPECT_THROW(Image(1, 1, 1, PixelType::u8).pixels<float>(), ArgumentError);
}

TEST(Image, GivesPixelsOfItsOwnTypeAlone) {
    Image bytes(2, 1, 3, PixelType::u8), shorts(2, 1, 3, PixelType::u16), floats(2, 1, 3, PixelType::f32);
    EXPECT_EQ(bytes.pixels<uint8_t>().size(), 6u);
    EXPECT_EQ(bytes.pixels<std::byte>().size(), 6u);
    EXPECT_EQ(shorts.pixels<uint16_t>().size(), 6u);
    EXPECT_EQ(std::as_const(floats).pixels<float>().size(), 6u);
    EXPECT_THROW(bytes.pixels<float>(), ArgumentError);
    EXPECT_THROW(bytes.pixels<bool>(), ArgumentError);
    EXPECT_THROW(shorts.pixels<int16_t>(), ArgumentError);
    EXPECT_THROW(floats.pixels<double>(), ArgumentError);
    EXPECT_THROW(floats.pixels<int32_t>(), ArgumentError);
}

TEST(Image, ChangesItsChannels) {
    const Image grey = image_of<uint8_t>(2, 1, 1, PixelType::u8, {10, 20});
    EXPECT_EQ(values_of<uint8_t>(with_channels(grey, 4)),
              (std::vector<uint8_t>{10, 10, 10, 255, 20, 20, 20, 255}));
    const Image grey_alpha = image_of<uint16_t>(1, 1, 2, PixelType::u16, {7, 9});
    EXPECT_EQ(values_of<uint16_t>(with_channels(grey_alpha, 4)), (std::vector<uint16_t>{7, 7, 7, 9}));
    const Image rgba = image_of<float>(1, 1, 4, PixelType::f32, {1, 2, 3, 0.5f});
    EXPECT_EQ(values_of<float>(with_channels(rgba, 3)), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(values_of<float>(with_channels(with_channels(rgba, 3), 4)), (std::vector<float>{1, 2, 3, 1}));
}

TEST(Image, EncodesColorAndLeavesAlphaLinear) {
    // 255 * 0.73536 = 187.5 rounds to 188 (0.735357 * 255 = 187.516); alpha 0.5 * 255 = 127.5 rounds away
    // from zero.
    const Image linear = image_of<float>(1, 1, 4, PixelType::f32, {0.5f, -1, 7, 0.5f});
    EXPECT_EQ(values_of<uint8_t>(to_u8(linear)), (std::vector<uint8_t>{188, 0, 255, 128}));
    const Image nothing = image_of<float>(1, 1, 1, PixelType::f32, {std::numeric_limits<float>::quiet_NaN()});
    EXPECT_EQ(values_of<uint8_t>(to_u8(nothing)), (std::vector<uint8_t>{0}));
}

TEST(Image, LargestColorIsThatOfNumbersBesideAlpha) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(largest_color(image_of<float>(2, 1, 2, PixelType::f32, {0.5f, 9, 3, 1})), 3);
    EXPECT_EQ(largest_color(image_of<float>(2, 1, 3, PixelType::f32, {nan, 1, 2, 7, nan, 4})), 7);
    EXPECT_EQ(largest_color(image_of<float>(1, 1, 1, PixelType::f32, {-2})), 0);
    EXPECT_THROW(largest_color(Image(1, 1, 1, PixelType::u8)), ArgumentError);
    // More than the loop's chunks of 65536 pixels.
    Image large(400, 400, 3, PixelType::f32);
    large.at<float>(399, 399)[2] = 5;
    large.at<float>(7, 0)[0] = 4;
    EXPECT_EQ(largest_color(large), 5);
}

// As above: 0.5 of light is code 188, as a number 128.
TEST(Image, TexelsAreEncodedByWhatTheyAre) {
    const Image texels = image_of<float>(1, 1, 2, PixelType::f32, {0.5f, 0.5f});
    EXPECT_EQ(values_of<uint8_t>(texels_to_u8(texels, true)), (std::vector<uint8_t>{188, 128}));
    EXPECT_EQ(values_of<uint8_t>(texels_to_u8(texels, false)), (std::vector<uint8_t>{128, 128}));
}

TEST(Image, AlphaIsTheLastOfTwoOrFourChannels) {
    for (const int channels : {1, 2, 3, 4})
        EXPECT_EQ(has_alpha(Image(1, 1, channels, PixelType::u8)), channels % 2 == 0) << channels;
    EXPECT_FALSE(has_alpha(Image()));
}

// 0.5 * 255 = 127.5 rounds away from zero; 65535 / 255 = 257.
TEST(Image, DataHasNoCurve) {
    const Image numbers = image_of<float>(1, 1, 4, PixelType::f32, {0.5f, -1, 7, 0.25f});
    EXPECT_EQ(values_of<uint8_t>(data_to_u8(numbers)), (std::vector<uint8_t>{128, 0, 255, 64}));
    const Image nothing = image_of<float>(1, 1, 1, PixelType::f32, {std::numeric_limits<float>::quiet_NaN()});
    EXPECT_EQ(values_of<uint8_t>(data_to_u8(nothing)), (std::vector<uint8_t>{0}));
    const Image wide = image_of<uint16_t>(2, 1, 1, PixelType::u16, {100 * 257, 65535});
    EXPECT_EQ(values_of<uint8_t>(data_to_u8(wide)), (std::vector<uint8_t>{100, 255}));
    const Image codes = image_of<uint8_t>(1, 1, 2, PixelType::u8, {7, 9});
    EXPECT_EQ(values_of<uint8_t>(data_to_u8(codes)), (std::vector<uint8_t>{7, 9}));
}

// Half of the red (0.25, 0, 0) is (0.125, 0, 0, 0.5) in floats, and code 137 (255 * 0.53710) straight.
TEST(Image, PicturesOfFloatsArePremultiplied) {
    const Image picture = image_of<float>(2, 1, 4, PixelType::f32, {0.125f, 0, 0, 0.5f, 0.5f, 0, 0, 0});
    EXPECT_EQ(values_of<uint8_t>(picture_to_u8(picture)), (std::vector<uint8_t>{137, 0, 0, 128, 0, 0, 0, 0}));
    const Image texture = image_of<float>(1, 1, 4, PixelType::f32, {0.25f, 0, 0, 0.5f});
    EXPECT_EQ(values_of<uint8_t>(to_u8(texture)), (std::vector<uint8_t>{137, 0, 0, 128}));
    const Image codes = image_of<uint8_t>(1, 1, 2, PixelType::u8, {255, 51});
    EXPECT_EQ(values_of<float>(picture_to_linear_f32(codes)), (std::vector<float>{0.2f, 0.2f}));
    EXPECT_EQ(values_of<float>(picture_to_linear_f32(picture)), values_of<float>(picture));
    const Image color = image_of<float>(1, 1, 3, PixelType::f32, {0.5f, 1, 0});
    EXPECT_EQ(values_of<float>(premultiplied(color)), values_of<float>(color));
    EXPECT_EQ(values_of<float>(unpremultiplied(color)), values_of<float>(color));
}

TEST(Image, TellsWhetherSomethingShinesThrough) {
    EXPECT_TRUE(is_fully_opaque(image_of<uint8_t>(1, 1, 3, PixelType::u8, {1, 2, 3})));
    EXPECT_TRUE(is_fully_opaque(image_of<uint8_t>(2, 1, 2, PixelType::u8, {1, 255, 3, 255})));
    EXPECT_FALSE(is_fully_opaque(image_of<uint8_t>(2, 1, 2, PixelType::u8, {1, 255, 3, 254})));
    EXPECT_FALSE(is_fully_opaque(image_of<uint16_t>(1, 1, 2, PixelType::u16, {1, 65534})));
    EXPECT_TRUE(is_fully_opaque(image_of<float>(1, 1, 4, PixelType::f32, {1, 2, 3, 0.9999f})));
    EXPECT_FALSE(is_fully_opaque(image_of<float>(1, 1, 4, PixelType::f32, {1, 2, 3, 0.99f})));
}

TEST(Image, SurvivesTheWayToLinearAndBack) {
    Image codes(256, 1, 2, PixelType::u8);
    for (int i = 0; i < 256; ++i) codes.at<uint8_t>(i, 0)[0] = codes.at<uint8_t>(i, 0)[1] = uint8_t(i);
    EXPECT_EQ(compare(to_u8(to_linear_f32(codes)), codes).different, 0u);
    // 65535 / 255 = 257, so k * 257 is exactly the 8-bit code k.
    const Image wide = image_of<uint16_t>(3, 1, 1, PixelType::u16, {0, 100 * 257, 65535});
    EXPECT_EQ(values_of<uint8_t>(to_u8(wide)), (std::vector<uint8_t>{0, 100, 255}));
}

TEST(Image, HalvesByAveraging) {
    const Image odd = image_of<float>(3, 2, 1, PixelType::f32, {1, 3, 100, 5, 7, 100});
    EXPECT_EQ(values_of<float>(half_size(odd)), (std::vector<float>{4}));
    const Image column = image_of<float>(1, 2, 1, PixelType::f32, {2, 4});
    EXPECT_EQ(values_of<float>(half_size(column)), (std::vector<float>{3}));
}

TEST(Image, OnlyFloatsAreHalved) {
    EXPECT_THROW(half_size(Image(4, 4, 3, PixelType::u8)), ArgumentError);
    EXPECT_THROW(half_size(Image(4, 4, 3, PixelType::u16)), ArgumentError);
    EXPECT_THROW(half_size(Image()), ArgumentError);
}

TEST(Image, IsEmptyWhenItWasMovedFrom) {
    Image from = image_of<uint8_t>(2, 1, 1, PixelType::u8, {10, 20});
    Image to = std::move(from);
    EXPECT_EQ(values_of<uint8_t>(to), (std::vector<uint8_t>{10, 20}));
    EXPECT_TRUE(from.empty());
    EXPECT_EQ(from.width(), 0);
    EXPECT_EQ(from.height(), 0);
    EXPECT_EQ(from.channels(), 0);
    EXPECT_THROW(with_channels(from, 4), ArgumentError);
    Image assigned(3, 3, 4, PixelType::f32);
    assigned = std::move(to);
    EXPECT_EQ(values_of<uint8_t>(assigned), (std::vector<uint8_t>{10, 20}));
    EXPECT_TRUE(to.empty());
    EXPECT_EQ(to.width(), 0);
    from = assigned;
    EXPECT_EQ(values_of<uint8_t>(from), values_of<uint8_t>(assigned));
}

TEST(Compare, MeasuresEveryDifference) {
    const Image a = image_of<uint8_t>(2, 1, 2, PixelType::u8, {0, 0, 10, 10});
    const Image b = image_of<uint8_t>(2, 1, 2, PixelType::u8, {0, 0, 13, 14});
    const ImageDifference d = compare(a, b);
    EXPECT_EQ(d.max, 4);
    EXPECT_EQ(d.different, 1u);
    EXPECT_DOUBLE_EQ(d.mean, 7.0 / 4);
    EXPECT_DOUBLE_EQ(d.rmse, 2.5);  // sqrt((9 + 16) / 4)
    EXPECT_DOUBLE_EQ(d.psnr, 20 * std::log10(255 / 2.5));
}

TEST(Compare, KnowsEqualAndUnlikeImages) {
    const float infinity = std::numeric_limits<float>::infinity(),
                nan = std::numeric_limits<float>::quiet_NaN();
    const Image a = image_of<float>(1, 1, 2, PixelType::f32, {infinity, nan});
    EXPECT_EQ(compare(a, a).max, 0);
    EXPECT_EQ(compare(a, a).psnr, std::numeric_limits<double>::infinity());
    const Image b = image_of<float>(1, 1, 2, PixelType::f32, {infinity, 0});
    EXPECT_EQ(compare(a, b).max, std::numeric_limits<double>::infinity());
    EXPECT_THROW(compare(a, with_channels(a, 3)), ArgumentError);
    EXPECT_THROW(compare(a, to_u8(a)), ArgumentError);
}

}  // namespace easypbr::image_test
