// Denoisers on made light whose true value is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/luminance.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/denoise/edge_avoiding_filter.h"
#include "easypbr/render/denoise/open_image_denoise.h"
#include "easypbr/render/frame/surface_kind.h"

namespace easypbr::render::denoise_test {
namespace {

constexpr int frames = 16;

/// Two surfaces side by side, which differ by normal, colour or light.
struct Made {
    explicit Made(Vec2i size = {96, 64}) : light(make(size)), scratch(make(size)) { pixels.begin(size); }

    static Target make(Vec2i size) {
        Target target(gl::Format::rgba32f, size);
        target.write(target.whole());
        std::ranges::fill(target.pixels<Vec4>(), Vec4::Zero());
        return target;
    }
    /// Light with this mean in a column, and noise of this standard deviation.
    void set(int x, int y, float mean, float deviation, const Vec3& normal, const Vec3& reflectance) {
        const size_t i = size_t(y) * size_t(light.width()) + size_t(x);
        std::normal_distribution<float> noise(0, deviation);
        const float value = mean + noise(random);
        light.pixels<Vec4>()[i] =
            Vec4(value * reflectance.x(), value * reflectance.y(), value * reflectance.z(),
                 std::pow(deviation * luminance(reflectance), 2.0f));
        native::NoisyTile& tile = pixels.make(pixels.grid().tile_at(x, y));
        const size_t place = TileGrid::place_of(x, y);
        for (int c = 0; c < 3; ++c) {
            tile.normal[c][place] = uint16_t(std::lrint((normal[c] + 1) / 2 * 65535));
            tile.reflectance[c][place] = uint16_t(std::lrint(reflectance[c] * 65535));
        }
        tile.depth[place] = -1;
        tile.frames[place] = frames;
    }
    /// Light of a colour, with noise of two kinds: the same factor of all channels, and `hue`, of which no
    /// luminance is left.
    void set_color(int x, int y, const Vec3& mean, float deviation, float hue) {
        set(x, y, 1, 0, Vec3(0, 0, 1), Vec3(1, 1, 1));
        std::normal_distribution<float> noise;
        const Vec3 turned = hue * Vec3(0.7152f, -0.2126f, 0),
                   value = mean * (1 + deviation * noise(random)) + turned * noise(random);
        Vec4& pixel = light.pixels<Vec4>()[size_t(y) * size_t(light.width()) + size_t(x)];
        pixel << value, std::pow(deviation * luminance(mean), 2.0f);
        native::NoisyTile& tile = pixels.make(pixels.grid().tile_at(x, y));
        const size_t place = TileGrid::place_of(x, y);
        // Sums of frames whose means have this variance.
        const auto sum_of = [](float square, float variance) {
            return float(frames) * (square + float(frames - 1) * variance);
        };
        for (int c = 0; c < 3; ++c) tile.light[c][place] = float(frames) * value[c];
        tile.squares[place] = sum_of(std::pow(luminance(value), 2.0f), pixel.w());
        const auto of_hue = [](const Vec3& c) { return c.x() * c.x() + c.z() * c.z(); };
        tile.hue_squares[native::NoisyTile::hue_place(int(place))] +=
            sum_of(of_hue(value), deviation * deviation * of_hue(mean) + of_hue(turned));
        tile.noisy[place] = uint8_t(Noisy::radiance);
    }
    NoisyLight noisy() const { return {light, pixels, scratch}; }

    Target light, scratch;
    TileValues<native::NoisyTile> pixels;
    std::mt19937 random{1};
};

/// A row of a frame with surfaces at some of its pixels, under a light of 1.
struct FrameRow {
    void set(int x, const Vec3& normal, const Vec3& color, float depth, SurfaceKind kind = SurfaceKind::lit) {
        const auto i = size_t(x);
        const Vec2 encoded = (oct_encode(normal) + Vec2(1, 1)) * 32767.5f;
        normals[i] = uint32_t(std::lrint(encoded.x())) | uint32_t(std::lrint(encoded.y())) << 16;
        albedos[i] = 0;
        for (int c = 0; c < 3; ++c) albedos[i] |= uint64_t(std::lrint(color[c] * 65535)) << (16 * c);
        // Metals send back their colour alone.
        materials[i] = 255u | uint32_t(kind) << 24;
        depths[i] = depth;
        samples[i] = Vec4::Ones();
    }
    Vec3 normal_of(int x) const {
        const uint32_t bits = normals[size_t(x)];
        return oct_decode(Vec2(float(bits & 0xffff), float(bits >> 16)) / 32767.5f - Vec2(1, 1));
    }
    native::NoisyRow row() const {
        native::NoisyRow row;
        row.sample = samples.data()->data();
        row.normal = normals.data();
        row.material = materials.data();
        row.albedo = albedos.data();
        row.depth = depths.data();
        row.end_of_lit = int(SurfaceKind::display);
        row.catcher = int(SurfaceKind::ground_catcher);
        row.over_nothing = true;
        return row;
    }

    std::vector<Vec4> samples = std::vector<Vec4>(native::NoisyRow::pixels, Vec4::Zero());
    std::array<uint32_t, native::NoisyRow::pixels> normals{}, materials{};
    std::array<uint64_t, native::NoisyRow::pixels> albedos{};
    std::array<float, native::NoisyRow::pixels> depths{};
};

float at(const Target& target, int x, int y) {
    return target.pixels<Vec4>()[size_t(y) * size_t(target.width()) + size_t(x)].x();
}

/// Mean and standard deviation of the pixels that are 16 or more from the border.
std::pair<double, double> statistics(const Target& target) {
    double sum = 0, squares = 0;
    int count = 0;
    for (int y = 16; y < 48; ++y)
        for (int x = 16; x < 80; ++x, ++count) {
            sum += at(target, x, y);
            squares += std::pow(at(target, x, y), 2.0);
        }
    const double mean = sum / count;
    return {mean, std::sqrt(squares / count - mean * mean)};
}

// Steps of 1 / 65535 are rounded in each of a thousand frames. Frame k's rounding, of 0.29 steps, is left
// with a weight of k / 1000: 0.29 sqrt(1000 / 3) = 5 steps in all, 8e-5. Three of these deviations
// are 2.4e-4, of normals, which are twice as long, 4.8e-4; guides of 8 bits tell 3.9e-3 apart.
TEST(Denoise, SurfacesAreMeansOfTheirFrames) {
    native::NoisyTile tile;
    std::mt19937 random{1};
    std::uniform_real_distribution<float> value(0, 1);
    Vec3d normal(0, 0, 0), reflectance(0, 0, 0);
    double depth = 0;
    constexpr int count = 1000, y = 3, x = 5;
    constexpr size_t place = y * native::NoisyTile::side + x;
    for (int frame = 0; frame < count; ++frame) {
        const Vec3 n = Vec3(2 * value(random) - 1, 2 * value(random) - 1, 1).normalized(),
                   color(value(random), 0, 1);
        const float d = value(random) + 0.01f;
        FrameRow row;
        row.set(x, n, color, d);
        native::BesideNoisy beside;
        EXPECT_FALSE(native::add_noisy_row(row.row(), y, tile, beside));
        normal += row.normal_of(x).cast<double>() / count;
        reflectance += color.cast<double>() / count;
        depth += std::log2(double(d)) / count;
    }
    const SurfaceMean surface = noisy_surface_at(tile, place);
    EXPECT_EQ(surface.frames, unsigned(count));
    EXPECT_LT((surface.mean_normal().cast<double>() - normal).norm(), 4.8e-4);
    EXPECT_LT((surface.mean_reflectance().cast<double>() - reflectance).norm(), 2.4e-4);
    EXPECT_NEAR(surface.depth, depth, 1e-4);
    for (size_t i = 0; i < native::NoisyTile::pixels; ++i)
        EXPECT_EQ(tile.frames[i], i == place ? unsigned(count) : 0u);
}

// A pixel keeps the kind of noise of its first frame: light of the other kind goes beside it. 4 of a lit
// surface and 2 of a ground that catches shadows over nothing; the coverage of the latter is noisy.
TEST(Denoise, OtherKindsOfNoiseGoBeside) {
    native::NoisyTile tile;
    native::BesideNoisy beside;
    const auto add = [&](SurfaceKind kind, float light, float coverage) {
        FrameRow row;
        row.set(7, Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0.5f), 0.5f, kind);
        row.samples[7] = Vec4(light, light, light, coverage);
        return native::add_noisy_row(row.row(), 0, tile, beside);
    };
    EXPECT_FALSE(add(SurfaceKind::lit, 4, 1));
    EXPECT_EQ(beside.taken[7], int(Noisy::radiance));
    EXPECT_TRUE(add(SurfaceKind::ground_catcher, 2, 0.25f));
    EXPECT_EQ(beside.taken[7], int(Noisy::nothing));
    EXPECT_EQ(beside.radiance[0][7], 2);
    EXPECT_EQ(beside.radiance[3][7], 0.25f);
    const NoisyPixel pixel = noisy_pixel_at(tile, 7);
    EXPECT_EQ(pixel.light, Vec3(4, 4, 4));
    EXPECT_NEAR(pixel.squares, 16, 1e-5);
    EXPECT_NEAR(tile.hue_squares[7], 32, 1e-5);
    EXPECT_EQ(pixel.alpha, 1);
    EXPECT_EQ(pixel.frames, 1u);
}

// Red and blue of eight rows have one sum: light of 2 has squares of 8.
TEST(Denoise, SquaresOfHuesAreSummedByColumns) {
    native::NoisyTile tile;
    native::BesideNoisy beside;
    FrameRow row;
    row.set(5, Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0.5f), 0.5f);
    row.samples[5] = Vec4(2, 2, 2, 1);
    for (int y = 6; y < 16; ++y) native::add_noisy_row(row.row(), y, tile, beside);
    EXPECT_NEAR(tile.hue_squares[5], 2 * 8, 1e-5);
    EXPECT_NEAR(tile.hue_squares[native::NoisyTile::side + 5], 8 * 8, 1e-5);
}

// A layer that covers a half, over a ground with a shadow of a half: 0.75 is covered, and the layer alone
// sends light back. A step of 1 / 65535 of rounding each.
TEST(Denoise, ShadowsBehindLayersSendNoLight) {
    for (const bool layered : {true, false}) {
        native::NoisyTile tile;
        native::BesideNoisy beside;
        FrameRow row;
        row.set(7, Vec3(0, 0, 1), Vec3(0.8f, 0.8f, 0.8f), 0.5f);
        row.albedos[7] |= uint64_t(32768) << 48;
        row.samples[7] = Vec4(0.4f, 0.4f, 0.4f, 0.75f);
        native::NoisyRow noisy = row.row();
        noisy.layered = layered;
        native::add_noisy_row(noisy, 0, tile, beside);
        EXPECT_NEAR(tile.reflectance[0][7], 65535 * 0.8 * (layered ? 0.5 : 0.75), 2) << layered;
    }
}

// Even light stays even, with a fraction of its noise: the mean over a part of the picture within 1 %, and
// the deviation, of a tenth, below a fiftieth.
TEST(Denoise, FilterSmoothsEvenLight) {
    Made made;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) made.set(x, y, 1, 0.1f, Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0.5f));
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    const auto [mean, deviation] = statistics(smooth);
    EXPECT_NEAR(mean, 0.5, 0.005);
    EXPECT_LT(deviation, 0.01);
}

// Few paths find a small lamp: one pixel in five has five times the light, and the variance of that; the
// others have neither. What is left of a deviation of twice the mean is a fifth of it, as of the mean of
// hundred pixels. The mean of 2048 pixels is within three of its deviations, 1 / sqrt(2048) each.
TEST(Denoise, FilterFillsWhatIsDarkByChance) {
    Made made;
    std::bernoulli_distribution found(0.2);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            made.set(x, y, found(made.random) ? 5.0f : 0.0f, 0, Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0.5f));
            Vec4& light = made.light.pixels<Vec4>()[size_t(y) * 96 + size_t(x)];
            light.w() = light.x() * light.x();
        }
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    const auto [mean, deviation] = statistics(smooth);
    EXPECT_NEAR(mean, 0.5, 0.066);
    EXPECT_LT(deviation, 0.1);
}

/// Two even halves that differ in one way; the means on both sides of the border after the filter.
std::pair<float, float> beside_border(float left, float right, const Vec3& right_normal,
                                      const Vec3& right_color) {
    Made made;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            x < 48 ? made.set(x, y, left, 0.1f, Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0.5f))
                   : made.set(x, y, right, 0.1f, right_normal, right_color);
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    float before = 0, after = 0;
    for (int y = 16; y < 48; ++y) {
        before += at(smooth, 47, y) / 32;
        after += at(smooth, 48, y) / 32;
    }
    return {before, after};
}

// Light differs by ten deviations, by normal or by colour: the columns at the border keep their means. 0.01:
// twice the noise that is left of the mean of 32 pixels.
TEST(Denoise, FilterStopsAtEdges) {
    const Vec3 ahead(0, 0, 1), aside(1, 0, 0), grey(0.5f, 0.5f, 0.5f), dark(0.1f, 0.1f, 0.1f);
    auto [before, after] = beside_border(1, 2, ahead, grey);
    EXPECT_NEAR(before, 0.5, 0.01);
    EXPECT_NEAR(after, 1, 0.01);
    std::tie(before, after) = beside_border(1, 1.2f, aside, grey);
    EXPECT_NEAR(before, 0.5, 0.01);
    EXPECT_NEAR(after, 0.6, 0.01);
    std::tie(before, after) = beside_border(1, 1, ahead, dark);
    EXPECT_NEAR(before, 0.5, 0.01);
    EXPECT_NEAR(after, 0.1, 0.01);
}

/// The quadratic mean of the error that the filter leaves in all channels.
template <class Color>
double error_of_color(float deviation, float hue, Color&& color) {
    Made made;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) made.set_color(x, y, color(x), deviation, hue);
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    double squares = 0;
    for (int y = 16; y < 48; ++y)
        for (int x = 16; x < 80; ++x)
            squares += (smooth.pixels<Vec4>()[size_t(y) * 96 + size_t(x)].head<3>() - color(x)).squaredNorm();
    return std::sqrt(squares / (3 * 32 * 64));
}

// Stripes of two colours of the same luminance, 0.278, as a mirror shows them: the channels differ by 0.55,
// 0.11 and 0.5. Of noise of a hundredth, and of 1 / 10000, no more is left than there was: the
// quadratic mean of the channels is 0.38. Stripes that are mixed would be wrong by 0.2.
TEST(Denoise, FilterStopsAtColorsOfOneLuminance) {
    const Vec3 one(0.6f, 0.2f, 0.1f), other(0.05f, 0.31301734f, 0.6f);
    const auto striped = [&](int x) -> Vec3 { return x / 8 % 2 ? one : other; };
    EXPECT_LT(error_of_color(0.01f, 0, striped), 0.0039);
    EXPECT_LT(error_of_color(1e-4f, 0, striped), 3.9e-5);
}

// Noise that only the colour has, twice and ten times as much as that of luminance: the quadratic mean of
// the channels' noise is 0.43 of it. A quarter is left at most.
TEST(Denoise, FilterSmoothsNoiseOfColors) {
    const auto even = [](int) -> Vec3 { return {0.5f, 0.5f, 0.5f}; };
    EXPECT_LT(error_of_color(0.2f, 0.2f, even), 0.43 * 0.2 / 4);
    EXPECT_LT(error_of_color(0.04f, 0.2f, even), 0.43 * 0.2 / 4);
}

/// The error that the filter leaves of noise on a surface whose normals turn by up to 60 degrees from pixel
/// to pixel, in parts of the noise. `change`: of the light, with the normal.
double error_where_surfaces_turn(float change, float deviation) {
    Made made;
    std::uniform_real_distribution<float> slope(0, float(pi) / 6), side(0, float(2 * pi));
    std::vector<float> expected;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const float a = slope(made.random), b = side(made.random);
            const Vec3 normal(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
            expected.push_back(1 + change * normal.x());
            made.set(x, y, expected.back(), deviation, normal, Vec3(1, 1, 1));
        }
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    double squares = 0;
    for (int y = 16; y < 48; ++y)
        for (int x = 16; x < 80; ++x)
            squares += std::pow(at(smooth, x, y) - expected[size_t(y) * 96 + size_t(x)], 2.0);
    return std::sqrt(squares / (32 * 64)) / deviation;
}

// No pixel has a neighbour that is turned as it is. Light that is noisier than it changes with the normal is
// the mean of 5x5 pixels all the same: of binomial weights 70 / 256 of the noise would be left, of these,
// which fall with the angle, no more than half. Light that changes by ten times its noise keeps what it is.
TEST(Denoise, FilterSmoothsNoiseWhereSurfacesTurnFast) {
    EXPECT_LT(error_where_surfaces_turn(0, 0.4f), 0.5);
    EXPECT_LT(error_where_surfaces_turn(0.2f, 0.4f), 0.6);
    EXPECT_LT(error_where_surfaces_turn(1, 0.03f), 1.1);
}

// Where no frame shows a surface, nothing is read and nothing written.
TEST(Denoise, FilterLeavesNothingAlone) {
    Made made;
    for (int y = 0; y < 64; ++y)
        for (int x = 48; x < 96; ++x) made.set(x, y, 1, 0.1f, Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0.5f));
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    float after = 0;
    for (int y = 0; y < 64; ++y) {
        EXPECT_EQ(at(smooth, 47, y), 0);
        after += at(smooth, 48, y) / 64;
    }
    EXPECT_NEAR(after, 0.5, 0.01);
}

// Light without noise is left as it is, to the last bits of float.
TEST(Denoise, FilterKeepsWhatIsCertain) {
    Made made;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            made.set(x, y, float(1 + (x + y) % 3), 0, Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0.5f));
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) EXPECT_NEAR(at(smooth, x, y), 0.5f * float(1 + (x + y) % 3), 1e-5f);
}

// A lamp in smooth metal: light that falls by ten from ring to ring, with a fifth of it as noise in each
// pixel, on an even ground of 0.1. The rings keep what they are within a half, which is three deviations of
// single pixels; where noise is taken from what is brighter around, those of 1 and 10 become that of 100.
TEST(Denoise, FilterKeepsTheShapeOfHighlights) {
    Made made;
    const auto ring = [](int x, int y) { return std::max(std::abs(x - 48), std::abs(y - 32)); };
    const auto light = [&](int x, int y) {
        return std::max(0.1f, 1000.0f * std::pow(0.1f, float(ring(x, y))));
    };
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            made.set(x, y, light(x, y), 0.2f * light(x, y), Vec3(0, 0, 1), Vec3(1, 1, 1));
    Transfers transfers;
    EdgeAvoidingFilter filter;
    const Target& smooth = filter.smooth(made.noisy(), transfers);
    for (int y = 26; y <= 38; ++y)
        for (int x = 42; x <= 54; ++x)
            if (ring(x, y) > 0) {
                EXPECT_NEAR(at(smooth, x, y) / light(x, y), 1, 0.5) << x << ' ' << y;
            }
}

// A library that is not there is named, with what to do.
TEST(Denoise, SaysWhatIsMissing) {
    if (!OpenImageDenoise::version().empty()) GTEST_SKIP() << "Open Image Denoise is there";
    Made made;
    OpenImageDenoise oidn;
    try {
        oidn.denoise(made.noisy());
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("pip install pyoidn"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace easypbr::render::denoise_test
