// The camera of the picture before, as the picture of a lens is drawn, and how its pixels are mixed.
#include "easypbr/app/lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/scene/motion.h"

namespace easypbr::app::lens_test {
namespace {

const Vec2i size(64, 48);

/// Numbers that no sum with others leaves as they are.
Camera pinhole() {
    Camera camera = Camera::look_at(Vec3d(0, 0, 5), Vec3d(0, 0, 0));
    camera.intrinsics = Intrinsics{80.1, 79.7, 31.3, 24.7, 64, 48};
    return camera;
}

Camera with_lens(const std::vector<double>& coefficients, double skew = 0) {
    Camera camera = pinhole();
    camera.intrinsics->skew = skew;
    if (!coefficients.empty())
        camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, coefficients);
    return camera;
}

void expect_equal(const Intrinsics& a, const Intrinsics& b) {
    EXPECT_EQ(a.fx, b.fx);
    EXPECT_EQ(a.fy, b.fy);
    EXPECT_EQ(a.cx, b.cx);
    EXPECT_EQ(a.cy, b.cy);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.skew, b.skew);
}

TEST(DrawnBefore, IsExactlyWhatIsDrawnWhereNothingChanges) {
    for (const Camera& now :
         {with_lens({-0.3, 0.1, 0.01, 0.02}), with_lens({}, 4.3), with_lens({0.2, 0, 0, 0}, 4.3)})
        for (const int scale : {1, 3}) {
            const LensMap map = lens_map(now, scale * size);
            const Camera before = drawn_before(now, now, map);
            EXPECT_FALSE(before.is_warped());
            expect_equal(*before.intrinsics, *map.drawn.intrinsics);
            for (const double t : {0.0, 0.3, 1.0})
                expect_equal(*between(before, map.drawn, t).intrinsics, *map.drawn.intrinsics);
        }
}

// What bends rays stays with the picture: another distortion is no motion.
TEST(DrawnBefore, KnowsNoOtherLens) {
    const Camera now = with_lens({-0.3, 0.1, 0.01, 0.02}, 4.3);
    const LensMap map = lens_map(now, size);
    for (const Camera& before : {pinhole(), with_lens({0.1, 0, 0, 0}), with_lens({0.1, 0, 0, 0}, -2)})
        expect_equal(*drawn_before(before, now, map).intrinsics, *map.drawn.intrinsics);
}

// A picture of twice the size of K: the focal length grew from 80.1 to 90.1, and the principal point came
// from 3 to the right and 2 further up.
TEST(DrawnBefore, ZoomsAndShiftsAsTheCameraDoes) {
    const Camera now = with_lens({-0.3, 0.1, 0, 0});
    Camera before = now;
    before.intrinsics->fx += 10;
    before.intrinsics->cx += 3;
    before.intrinsics->cy -= 2;
    const LensMap map = lens_map(now, 2 * size);
    const Intrinsics drawn = *drawn_before(before, now, map).intrinsics, &wide = *map.drawn.intrinsics;
    // Rounding of numbers up to 200.
    EXPECT_NEAR(drawn.fx, wide.fx + 20, 1e-12);
    EXPECT_NEAR(drawn.fy, wide.fy, 1e-12);
    EXPECT_NEAR(drawn.cx, wide.cx + 6, 1e-12);
    EXPECT_NEAR(drawn.cy, wide.cy - 4, 1e-12);
}

// Of a skewed camera without distortion a pixel's place in what is drawn has the ray of the camera before.
TEST(DrawnBefore, OfASkewedCameraSeesItsRays) {
    const Camera now = with_lens({}, 4);
    Camera before = now;
    before.intrinsics->cx += 3;
    const LensMap map = lens_map(now, size);
    const Intrinsics drawn = *drawn_before(before, now, map).intrinsics, &k = *before.intrinsics;
    for (const Vec2i& pixel : {Vec2i(0, 0), Vec2i(63, 0), Vec2i(20, 40), Vec2i(63, 47)}) {
        const double y = (pixel.y() - k.cy) / k.fy, x = (pixel.x() - k.cx - k.skew * y) / k.fx;
        const Vec2 place = map.source[size_t(pixel.y() * size.x() + pixel.x())];
        // Places are in single precision: 4e-6 of 64 pixels, 5e-8 of the focal length.
        EXPECT_NEAR((place.x() - drawn.cx) / drawn.fx, x, 1e-6);
        EXPECT_NEAR((place.y() - drawn.cy) / drawn.fy, y, 1e-6);
    }
}

TEST(DrawnBefore, WithoutALensIsTheCameraItself) {
    const Camera now = pinhole();
    const LensMap map = lens_map(now, size);
    Camera before = pinhole();
    before.intrinsics->cx += 3;
    expect_equal(*drawn_before(before, now, map).intrinsics, *before.intrinsics);
    // Nor has it one left that the lens was taken off.
    EXPECT_FALSE(drawn_before(with_lens({-0.3, 0.1, 0, 0}, 4), now, map).is_warped());
    Camera orthographic = now;
    orthographic.projection = Projection::orthographic;
    const Camera lens = with_lens({-0.3, 0.1, 0, 0});
    EXPECT_EQ(drawn_before(orthographic, lens, lens_map(lens, size)).projection, Projection::orthographic);
    const Camera plain = Camera::look_at(Vec3d(0, 0, 5), Vec3d(0, 0, 0));
    EXPECT_FALSE(drawn_before(plain, lens, lens_map(lens, size)).intrinsics);
}

/// The corner of a fisheye's picture, `side` pixels, whose far corner is 79.6 degrees (1.39) off the axis.
Camera rim_of_fisheye(double focal, int side) {
    const double centre = side - 1.39 * focal / std::sqrt(2.0);
    Camera camera = pinhole();
    camera.intrinsics = Intrinsics{focal, focal, centre, centre, side, side};
    camera.distortion = Distortion::from_coefficients(DistortionModel::fisheye, {0, 0, 0, 0});
    return camera;
}

// The far corner has slopes of 5.5 / sqrt(2) = 3.87 along both axes. The near one, 1000 pixels before it, is
// 1.39 - 1000 sqrt(2) / 20000 = 1.319 off the axis, with slopes of 3.9 / sqrt(2) = 2.75: about 1.1 * 20000 =
// 22000 pixels a side are drawn. Of 2000 pixels it is 35000, which is less than 65536, but too many in all.
TEST(LensMap, RefusesMoreDrawnPixelsThanAPictureHas) {
    const LensMap fits = lens_map(rim_of_fisheye(20000, 1000), {1000, 1000});
    EXPECT_GT(fits.drawn_size.minCoeff(), 20000);
    EXPECT_LE(int64_t(fits.drawn_size.x()) * fits.drawn_size.y(), int64_t(1) << 30);
    try {
        lens_map(rim_of_fisheye(20000, 2000), {2000, 2000});
        ADD_FAILURE() << "no error";
    } catch (const ArgumentError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("2000x2000"), message.npos) << message;
        EXPECT_NE(message.find("1073741824 in all"), message.npos) << message;
    }
}

// A row of 64 x 48 pixels is shifted by skew / fy per row: 47 rows by 1e6 / 79.7 each are 590,000 pixels.
TEST(LensMap, RefusesSkewInTheSameWords) {
    try {
        lens_map(with_lens({}, 1e6), size);
        ADD_FAILURE() << "no error";
    } catch (const ArgumentError& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with("camera: a picture of 64x48 pixels is drawn as one of ")) << message;
        EXPECT_NE(message.find(" without distortion and skew, "), message.npos) << message;
    }
}

/// One pixel, whose place in a drawn picture of 2 x 2 is (x, y).
LensMap one_pixel(float x, float y) {
    LensMap map;
    map.size = {1, 1};
    map.drawn_size = {2, 2};
    map.source = {Vec2(x, y)};
    return map;
}

template <class T>
void set(Image& image, int x, int y, const std::array<int, 4>& pixel) {
    for (size_t c = 0; c < 4; ++c) image.at<T>(x, y)[c] = T(pixel[c]);
}

/// Opaque codes of 8 bits with a third of that alpha to their right, the same in both rows.
template <class T>
void expect_mixed_by_alpha(PixelType type) {
    constexpr int one = std::numeric_limits<T>::max() / 255;  // 257 of 16 bits
    Image drawn(2, 2, 4, type);
    for (const int y : {0, 1}) {
        set<T>(drawn, 0, y, {200 * one, 0, 255 * one, 255 * one});
        set<T>(drawn, 1, y, {100 * one, 170 * one, 255 * one, 85 * one});
    }
    // A quarter of the way alpha is 3/4 * 255 + 1/4 * 85 = 212.5; of the light the second one has the part
    // (85 / 4) / 212.5 = 1/10. By the curve of sRGB 200 and 100 are the light 0.57758 and 0.12744, whose mean
    // 0.53257 is 192.8851; 170 is 0.40198, a tenth of which is 56.4784.
    const Image mixed = warp(drawn, one_pixel(0.25f, 0.5f));
    EXPECT_EQ(mixed.at<T>(0, 0)[0], std::lround(192.8851 * one));
    EXPECT_EQ(mixed.at<T>(0, 0)[1], std::lround(56.47842 * one));
    EXPECT_EQ(mixed.at<T>(0, 0)[2], 255 * one);
    EXPECT_EQ(mixed.at<T>(0, 0)[3], std::lround(212.5 * one));
}

TEST(Warp, MixesStraightColourByItsAlpha) {
    expect_mixed_by_alpha<uint8_t>(PixelType::u8);
    expect_mixed_by_alpha<uint16_t>(PixelType::u16);
}

// Nothing has no colour: what is white beside it stays white, as far as anything is seen of it.
TEST(Warp, LeavesTheColourOfBordersAlone) {
    Image drawn(2, 2, 4, PixelType::u8);
    set<uint8_t>(drawn, 0, 0, {255, 255, 255, 255});
    for (const float x : {0.0f, 0.3f, 0.9f}) {
        const Image mixed = warp(drawn, one_pixel(x, 0.25f));
        EXPECT_EQ(mixed.at<uint8_t>(0, 0)[0], 255) << x;
        EXPECT_EQ(mixed.at<uint8_t>(0, 0)[3], std::lround(255 * (1 - x) * 0.75f)) << x;
    }
    const Image none = warp(drawn, one_pixel(1, 1));
    for (int c = 0; c < 4; ++c) EXPECT_EQ(none.at<uint8_t>(0, 0)[c], 0);
}

// Premultiplied light is mixed as it is. Opaque codes are mixed as light: 3/4 of 0.57758 (200) and 1/4 of
// 0.12744 (100) are 0.46504, which is 181.52; a mean of codes were 175.
TEST(Warp, MixesOpaqueColourAsLight) {
    Image codes(2, 2, 4, PixelType::u8), light(2, 2, 4, PixelType::f32);
    for (const int y : {0, 1}) {
        set<uint8_t>(codes, 0, y, {200, 0, 0, 255});
        set<uint8_t>(codes, 1, y, {100, 0, 0, 255});
        set<float>(light, 0, y, {4, 0, 0, 1});
        set<float>(light, 1, y, {2, 0, 0, 0});
    }
    EXPECT_EQ(warp(codes, one_pixel(0.25f, 0.5f)).at<uint8_t>(0, 0)[0], 182);
    EXPECT_EQ(warp(codes, one_pixel(0.25f, 0.5f)).at<uint8_t>(0, 0)[3], 255);
    EXPECT_EQ(warp(light, one_pixel(0.25f, 0.5f)).at<float>(0, 0)[0], 3.5f);
    EXPECT_EQ(warp(light, one_pixel(0.25f, 0.5f)).at<float>(0, 0)[3], 0.75f);
}

double light_of(double code) {
    const double c = code / 255;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double code_of(double light) {
    return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

// All neighbouring codes and all distances from black, by 64 steps of light each.
TEST(Warp, TakesTheNearestCodeOfEachLight) {
    constexpr int steps = 64;
    for (int code = 0; code < 255; ++code)
        for (const int other : {code + 1, 0})
            for (int i = 0; i < steps; ++i) {
                Image codes(2, 2, 4, PixelType::u8);
                for (const int y : {0, 1}) {
                    set<uint8_t>(codes, 0, y, {code, 0, 0, 255});
                    set<uint8_t>(codes, 1, y, {other, 0, 0, 255});
                }
                const float part = float(i) / steps;
                const double expected =
                    code_of((1 - double(part)) * light_of(code) + double(part) * light_of(other));
                // Light in single precision is some 1e-7 off, of which the curve makes 255 * 12.92 at most.
                EXPECT_NEAR(warp(codes, one_pixel(part, 0.5f)).at<uint8_t>(0, 0)[0], expected, 0.5 + 4e-4)
                    << code << " " << other << " " << i;
            }
}

TEST(Warp, RefusesOtherThanFourChannels) {
    EXPECT_THROW(warp(Image(2, 2, 3, PixelType::u8), one_pixel(0.5f, 0.5f)), std::logic_error);
}

/// Pixels of one code keep it, wherever they are mixed.
template <class T>
void expect_codes_kept(PixelType type) {
    for (int code = 0; code <= std::numeric_limits<T>::max(); code += std::max(1, code / 50)) {
        Image drawn(2, 2, 4, type);
        const int alpha = std::numeric_limits<T>::max();
        for (const int y : {0, 1})
            for (const int x : {0, 1}) set<T>(drawn, x, y, {code, code, 7, alpha});
        drawn.at<T>(1, 1)[2] = 9;  // All of them are mixed.
        const Image mixed = warp(drawn, one_pixel(0.3f, 0.7f));
        EXPECT_EQ(mixed.at<T>(0, 0)[0], code);
        EXPECT_EQ(mixed.at<T>(0, 0)[3], alpha);
    }
}

TEST(Warp, KeepsWhatIsOfOneColour) {
    expect_codes_kept<uint8_t>(PixelType::u8);
    expect_codes_kept<uint16_t>(PixelType::u16);
}

// Next to a marked pixel the nearest is taken, marked or not.
TEST(Warp, TakesTheNearestPixelWhereNothingMayMix) {
    Image codes(2, 2, 4, PixelType::u8), marks(2, 2, 1, PixelType::u8);
    for (const int y : {0, 1}) {
        set<uint8_t>(codes, 0, y, {200, 0, 0, 255});
        set<uint8_t>(codes, 1, y, {100, 0, 0, 255});
    }
    const LensMap left = one_pixel(0.25f, 0.5f), right = one_pixel(0.75f, 0.5f);
    EXPECT_EQ(warp(codes, left, &marks).at<uint8_t>(0, 0)[0], 182);
    marks.at<uint8_t>(1, 1)[0] = 255;
    EXPECT_EQ(warp(codes, left, &marks).at<uint8_t>(0, 0)[0], 200);
    EXPECT_EQ(warp(codes, right, &marks).at<uint8_t>(0, 0)[0], 100);
}

}  // namespace
}  // namespace easypbr::app::lens_test
