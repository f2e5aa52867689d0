// Denoisers on made light whose true value is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/luminance.h"
#include "easypbr/render/denoise/edge_avoiding_filter.h"
#include "easypbr/render/denoise/open_image_denoise.h"

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
        SurfaceMean& surface = pixels.make(pixels.grid().tile_at(x, y))[TileGrid::place_of(x, y)].surface;
        surface = {};
        for (int frame = 0; frame < frames; ++frame) surface.add(normal, reflectance, -1);
    }
    NoisyLight noisy() const { return {light, pixels, scratch}; }

    Target light, scratch;
    TilePixels<NoisyPixel> pixels;
    std::mt19937 random{1};
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
    SurfaceMean surface;
    std::mt19937 random{1};
    std::uniform_real_distribution<float> value(0, 1);
    Vec3d normal(0, 0, 0), reflectance(0, 0, 0);
    double depth = 0;
    constexpr int count = 1000;
    for (int frame = 0; frame < count; ++frame) {
        const Vec3 n(2 * value(random) - 1, 2 * value(random) - 1, 1), color(value(random), 0, 1);
        const float d = -10 * value(random);
        surface.add(n, color, d);
        normal += n.cast<double>() / count;
        reflectance += color.cast<double>() / count;
        depth += double(d) / count;
    }
    EXPECT_EQ(surface.frames, unsigned(count));
    EXPECT_LT((surface.mean_normal().cast<double>() - normal).norm(), 4.8e-4);
    EXPECT_LT((surface.mean_reflectance().cast<double>() - reflectance).norm(), 2.4e-4);
    EXPECT_NEAR(surface.depth, depth, 1e-4);
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
