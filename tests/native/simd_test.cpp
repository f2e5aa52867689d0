// GLSL's functions on lanes, against those of the standard library.
#define EASYPBR_ISA checked

#include "easypbr/native/flush_subnormals.h"
#include "easypbr/native/simd/samplers.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace easypbr::native::checked {
namespace {

using Function = vfloat (*)(vfloat);
using Reference = double (*)(double);

/// Largest error of `function` on [from, to], absolute, or relative to values beyond 1.
double error_of(Function function, Reference reference, double from, double to) {
    double worst = 0;
    constexpr int steps = 100000;
    for (int i = 0; i <= steps; ++i) {
        const auto x = float(from + (to - from) * i / steps);
        const double value = double(function(vfloat(x)).v[0]), expected = reference(double(x));
        worst = std::max(worst, std::abs(value - expected) / std::max(1.0, std::abs(expected)));
    }
    return worst;
}

// The bounds are those that lanes.h states.
TEST(Lanes, ExponentialAndLogarithm) {
    EXPECT_LT(error_of(exp2, std::exp2, -20, 20), 4e-7);
    EXPECT_LT(error_of(log2, std::log2, 1e-6, 1e-3), 1e-6);
    EXPECT_LT(error_of(log2, std::log2, 1e-3, 100), 1e-6);
}

TEST(Lanes, HalvesAreRoundedAsTheirStandardSays) {
    const auto half_of = [](float v) { return to_halves(Floats4{v, 0, 0, 0})[0]; };
    const auto check = [&](float v) {
        EXPECT_EQ(half_of(v), Eigen::half(v).x) << v;
        EXPECT_EQ(half_of(-v), Eigen::half(-v).x) << v;
    };
    // All halves, and what lies in the middle of two or beside it.
    const auto value_of = [](uint16_t bits) { return float(Eigen::numext::bit_cast<Eigen::half>(bits)); };
    for (uint16_t bits = 0; bits < 0x7bff; ++bits) {
        const float v = value_of(bits), middle = 0.5f * (v + value_of(uint16_t(bits + 1)));
        check(v);
        check(middle);
        check(std::nextafter(middle, 0.0f));
        check(std::nextafter(middle, 1e30f));
    }
    for (const float v : {65519.9f, 65520.0f, 1e9f, std::numeric_limits<float>::infinity(), 1e-40f}) check(v);
    EXPECT_GT(half_of(std::nanf("")) & 0x7fff, 0x7c00);
}

TEST(Lanes, Angles) {
    EXPECT_LT(error_of(acos, std::acos, -1, 1), 1e-6);
    EXPECT_LT(error_of(sin, std::sin, -100, 100), 1e-5);
    EXPECT_LT(error_of(cos, std::cos, -100, 100), 1e-5);
    for (double angle = -3.14; angle < 3.14; angle += 0.001) {
        const auto y = float(std::sin(angle)), x = float(std::cos(angle));
        EXPECT_NEAR(double(atan(vfloat(y), vfloat(x)).v[0]), std::atan2(double(y), double(x)), 1e-5);
    }
}

TEST(Lanes, Roots) {
    EXPECT_EQ(error_of(
                  sqrt, [](double x) { return double(std::sqrt(float(x))); }, 0, 1000),
              0);
    EXPECT_LT(error_of(
                  inversesqrt, [](double x) { return 1 / std::sqrt(x); }, 0.01, 1000),
              2e-7);
    EXPECT_EQ(error_of(floor, std::floor, -1000, 1000), 0);
}

TEST(Lanes, PowerOfZeroIsZero) {
    EXPECT_EQ(pow(vfloat(0.0f), vfloat(2.4f)).v[0], 0.0f);
    EXPECT_NEAR(pow(vfloat(0.5f), vfloat(2.4f)).v[0], std::pow(0.5, 2.4), 1e-6);
}

TEST(Lanes, RootOfDisplayLight) {
    const auto error_at = [](float x) {
        return std::abs(double(root_2_4(vfloat(x)).v[0]) / std::pow(double(x), 1 / 2.4) - 1);
    };
    for (float x = 0x1p-9f; x < 100; x *= 1.0001f) EXPECT_LT(error_at(x), 2e-6) << x;
    // Where one power follows another.
    for (float x = 0x1p-8f; x < 100; x *= 2)
        for (const float at : {x, std::nextafter(x, 0.0f)}) EXPECT_LT(error_at(at), 2e-6) << at;
    EXPECT_EQ(root_2_4(vfloat(std::nanf(""))).v[0], root_2_4(vfloat(0.0f)).v[0]);
}

TEST(Lanes, CountsBits) {
    for (const unsigned bits : {0u, 1u, 0xffffffffu, 0x80000000u, 0x12345678u})
        EXPECT_EQ(bitCount(vuint(bits)).v[0], std::popcount(bits));
}

TEST(Lanes, ChoosesByLane) {
    const vfloat numbers = to_float(lane_numbers());
    const vfloat chosen = select(numbers < 2.0f, numbers, vfloat(-1.0f));
    for (int k = 0; k < lanes; ++k) EXPECT_EQ(chosen.v[k], k < 2 ? float(k) : -1.0f);
    EXPECT_TRUE(any_lane(numbers == 3.0f));
    EXPECT_FALSE(any_lane(numbers == 99.0f));
}

TEST(Samplers, HalvesAreExact) {
    for (int bits = 0; bits < 0x7c00; ++bits) {
        const auto h = uint16_t(bits);
        const float expected = float(Eigen::half(Eigen::half_impl::raw_uint16_to_half(h)));
        const FlushSubnormals flush;  // as kernels have it
        EXPECT_EQ(from_halves(Shorts4{h, h, h, h})[1], expected);
        EXPECT_EQ(from_halves(Shorts8{h, h, h, h, h, h, h, h})[6], expected);
    }
}

TEST(Samplers, PixelsAreTakenApartAndPutTogether) {
    std::array<float, 4 * lanes> pixels;
    std::iota(pixels.begin(), pixels.end(), 0.0f);
    const vec4 channels = load_row<FloatPixel>(reinterpret_cast<const std::byte*>(pixels.data()));
    for (int k = 0; k < lanes; ++k) {
        EXPECT_EQ(channels.x.v[k], float(4 * k));
        EXPECT_EQ(channels.w.v[k], float(4 * k + 3));
    }
    const PixelRow row = interleaved(channels);
    EXPECT_EQ(std::memcmp(row.v, pixels.data(), sizeof row.v), 0);
}

TEST(Samplers, BytesAndShortsHaveNoSign) {
    const Ints8 bytes = widened(Bytes8{0, 1, 127, 128, 200, 255, 2, 254}),
                shorts = widened(Shorts8{0, 1, 32767, 32768, 40000, 65535, 2, 65534});
    const std::array<int, 8> expected_bytes{0, 1, 127, 128, 200, 255, 2, 254},
        expected_shorts{0, 1, 32767, 32768, 40000, 65535, 2, 65534};
    for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(bytes[i], expected_bytes[size_t(i)]);
        EXPECT_EQ(shorts[i], expected_shorts[size_t(i)]);
    }
}

TEST(Samplers, GathersFourTexelsOfALayer) {
    constexpr int size = 6;
    std::vector<float> texels(2 * size * size);
    std::iota(texels.begin(), texels.end(), 0.0f);
    const Layers layers{texels.data(), size};
    const auto texel = [&](int x, int y) {
        return texels[size_t((size + std::clamp(y, 0, size - 1)) * size + std::clamp(x, 0, size - 1))];
    };
    // Corners between texels, also of the border and beyond it.
    for (int y = -1; y <= size + 1; ++y)
        for (int x = -1; x <= size + 1; ++x) {
            const vec3 corner(vfloat(float(x) / size), vfloat(float(y) / size), vfloat(1.0f));
            const vec4 found = textureGather(layers, corner);
            for (int k = 0; k < lanes; ++k) {
                EXPECT_EQ(found.x.v[k], texel(x - 1, y)) << x << ' ' << y;
                EXPECT_EQ(found.y.v[k], texel(x, y)) << x << ' ' << y;
                EXPECT_EQ(found.z.v[k], texel(x, y - 1)) << x << ' ' << y;
                EXPECT_EQ(found.w.v[k], texel(x - 1, y - 1)) << x << ' ' << y;
            }
        }
}

/// Two layers of random texels, of 3 by 3 blocks that are not all whole.
class LayerBounds : public testing::Test {
  protected:
    static constexpr int size = 40, blocks = Layers::blocks_of(size), most = 7;

    LayerBounds() {
        for (float& texel : texels_) texel = random(0, 1);
        const auto block_of = [](int layer, int x, int y) {
            return size_t((layer * blocks + y / Layers::block_size) * blocks + x / Layers::block_size);
        };
        for (int layer = 0; layer < 2; ++layer)
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    float &least = least_[block_of(layer, x, y)], &largest = largest_[block_of(layer, x, y)];
                    least = std::min(least, texel(layer, x, y));
                    largest = std::max(largest, texel(layer, x, y));
                }
    }
    float random(float low, float high) { return std::uniform_real_distribution(low, high)(generator_); }
    float texel(int layer, int x, int y) const { return texels_[size_t((layer * size + y) * size + x)]; }
    Layers layers() const { return {texels_.data(), size, least_.data(), largest_.data()}; }

  private:
    std::mt19937 generator_{3};
    std::vector<float> texels_ = std::vector<float>(2 * size * size);
    // Lanes beyond the last block are read, and not taken.
    std::vector<float> least_ = std::vector<float>(2 * blocks * blocks + lanes - 1, 2.0f),
                       largest_ = std::vector<float>(2 * blocks * blocks + lanes - 1, -2.0f);
};

TEST_F(LayerBounds, AreThoseOfTheBlocksAroundThePlacesThatAreNeeded) {
    for (int trial = 0; trial < 200; ++trial) {
        const float spread = trial % 2 == 0 ? 0.2f : 1.2f;
        const vec2 middle(random(0, 1), random(0, 1));
        vec3 place(vfloat(0.0f), vfloat(0.0f), vfloat(float(trial % 2)));
        vec2 distance;
        vbool needed = false;
        for (int k = 0; k < lanes; ++k) {
            place.x.v[k] = middle.x.v[0] + random(-spread, spread);
            place.y.v[k] = middle.y.v[0] + random(-spread, spread);
            distance.x.v[k] = random(0, 0.2f);
            distance.y.v[k] = random(0, 0.2f);
            needed.v[k] = k == trial % lanes || random(0, 1) < 0.3f ? -1 : 0;
        }
        // The rectangle around all of them, and a texel to each side; beyond the borders, their texels.
        const auto column = [](float at) { return std::clamp(int(std::floor(at * size)), 0, size - 1); };
        int left = size, right = 0, top = size, bottom = 0;
        for (int k = 0; k < lanes; ++k) {
            if (!needed.v[k]) continue;
            left = std::min(left, column(place.x.v[k] - distance.x.v[k] - 1.0f / size));
            right = std::max(right, column(place.x.v[k] + distance.x.v[k] + 1.0f / size));
            top = std::min(top, column(place.y.v[k] - distance.y.v[k] - 1.0f / size));
            bottom = std::max(bottom, column(place.y.v[k] + distance.y.v[k] + 1.0f / size));
        }
        const auto whole = [](int& first, int& last) {
            first -= first % Layers::block_size;
            last = std::min(size, last - last % Layers::block_size + Layers::block_size);
        };
        whole(left, right);
        whole(top, bottom);
        float least = 2, largest = -2;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                least = std::min(least, texel(trial % 2, x, y));
                largest = std::max(largest, texel(trial % 2, x, y));
            }
        const vec2 bounds = layer_bounds(layers(), place, distance, needed);
        EXPECT_EQ(bounds.x.v[0], least) << trial;
        EXPECT_EQ(bounds.y.v[lanes - 1], largest) << trial;
    }
}

TEST_F(LayerBounds, AreWideWhereTheyAreNotKnown) {
    vec3 place(vfloat(0.5f), vfloat(0.5f), vfloat(0.0f));
    const vec2 distance(vfloat(0.1f), vfloat(0.1f));
    const auto expect_wide = [](const vec2& bounds) {
        EXPECT_LT(bounds.x.v[0], -1e37f);
        EXPECT_GT(bounds.y.v[0], 1e37f);
    };
    Layers without = layers();
    without.least = without.largest = nullptr;
    expect_wide(layer_bounds(without, place, distance, true));
    expect_wide(layer_bounds(layers(), place, distance, false));
    place.z.v[lanes - 1] = 1;  // lanes of two layers
    expect_wide(layer_bounds(layers(), place, distance, true));
}

class Pictures : public testing::Test {
  protected:
    static constexpr int width = 5, height = 4;

    Pictures() {
        for (size_t i = 0; i < values_.size(); ++i) values_[i] = float(i + 1);
    }
    R32f view() const {
        R32f view;
        static_cast<View&>(view) = View{.data = reinterpret_cast<const std::byte*>(values_.data()),
                                        .width = width + 3,
                                        .height = height + 2,
                                        .x = 2,
                                        .y = 1,
                                        .held_width = width,
                                        .held_height = height};
        return view;
    }
    float expected(int x, int y) const {
        x = std::clamp(x, 0, width + 2) - 2;
        y = std::clamp(y, 0, height + 1) - 1;
        const bool inside = x >= 0 && x < width && y >= 0 && y < height;
        return inside ? values_[size_t(y * width + x)] : 0.0f;
    }
    std::vector<float> values_ = std::vector<float>(size_t(width * height));
};

// Beside the picture its border counts, within it what is not held is zero.
TEST_F(Pictures, FetchesAnywhere) {
    for (int y = -2; y < height + 5; ++y)
        for (int x = -3; x < width + 6; ++x)
            for (int step = 0; step < 3; ++step) {
                const vec4 found = fetch(view(), lane_numbers() * step + x, vint(y));
                for (int k = 0; k < lanes; ++k)
                    EXPECT_EQ(found.x.v[k], expected(x + k * step, y)) << x << ' ' << y;
            }
}

TEST_F(Pictures, FacesOfCubesAreOpenGLs) {
    const struct {
        vec3 direction;
        int face;
    } cases[] = {{{1.0f, 0.2f, -0.3f}, 0}, {{-1.0f, 0.2f, 0.3f}, 1}, {{0.1f, 1.0f, 0.2f}, 2},
                 {{0.1f, -1.0f, 0.2f}, 3}, {{0.1f, 0.2f, 1.0f}, 4},  {{0.1f, 0.2f, -1.0f}, 5}};
    for (const auto& c : cases) EXPECT_EQ(cube_place(c.direction).face.v[0], c.face);
    // Table 8.19: s of +x is -z, t is -y.
    const CubePlace place = cube_place({2.0f, 1.0f, -0.5f});
    EXPECT_FLOAT_EQ(place.s.v[0], 0.5f * (0.25f + 1));
    EXPECT_FLOAT_EQ(place.t.v[0], 0.5f * (-0.5f + 1));
}

/// An image with random levels: no level has to be the mean of the one before it.
class Levels {
  public:
    Levels(int width, int height, Texture::Wrap u, Texture::Wrap v, bool is_16_bit) {
        texture_.width = width;
        texture_.height = height;
        texture_.levels = std::bit_width(unsigned(std::max(width, height)));
        texture_.wrap_u = u;
        texture_.wrap_v = v;
        texture_.is_16_bit = is_16_bit;
        const size_t bytes = is_16_bit ? 2 : 1;
        size_t texels = 0;
        for (int l = 0; l < texture_.levels; ++l) {
            texture_.offsets[l] = int(texels);
            texels += size_t(width_of(l) + 1) * size_t(height_of(l));
        }
        data_.resize(4 * bytes * (texels + 1));
        for (std::byte& byte : data_) byte = std::byte(random_() & 255);
        for (int l = 0; l < texture_.levels; ++l)
            for (int y = 0; y < height_of(l); ++y)
                for (int c = 0; c < 4; ++c)
                    set(l, width_of(l), y, c,
                        code(l, u == Texture::Wrap::repeat ? 0 : width_of(l) - 1, y, c));
        texture_.texels = data_.data();
    }

    const Texture& texture() const { return texture_; }

    /// OpenGL 4.6, 8.14: equations 8.11 to 8.17, with the exact scale factor.
    double expected(double u, double v, const double (&changes)[4], double bias, int channel) const {
        const double w = texture_.width, h = texture_.height;
        const double scale =
            std::max(std::hypot(changes[0] * w, changes[1] * h), std::hypot(changes[2] * w, changes[3] * h));
        const double level = std::clamp(std::log2(scale) + bias, 0.0, double(texture_.levels - 1));
        const int fine = int(level), coarse = std::min(fine + 1, texture_.levels - 1);
        const double part = level - fine;
        return (1 - part) * bilinear(fine, u, v, channel) + part * bilinear(coarse, u, v, channel);
    }

  private:
    int width_of(int l) const { return std::max(1, texture_.width >> l); }
    int height_of(int l) const { return std::max(1, texture_.height >> l); }
    size_t place(int l, int x, int y, int c) const {
        return 4 * (size_t(texture_.offsets[l]) + size_t(y) * size_t(width_of(l) + 1) + size_t(x)) +
               size_t(c);
    }
    unsigned code(int l, int x, int y, int c) const {
        const size_t at = place(l, x, y, c);
        if (!texture_.is_16_bit) return unsigned(data_[at]);
        return unsigned(data_[2 * at]) | unsigned(data_[2 * at + 1]) << 8;
    }
    void set(int l, int x, int y, int c, unsigned code) {
        const size_t at = place(l, x, y, c);
        if (!texture_.is_16_bit) {
            data_[at] = std::byte(code);
            return;
        }
        data_[2 * at] = std::byte(code & 255);
        data_[2 * at + 1] = std::byte(code >> 8);
    }
    static int wrapped(int i, int n, Texture::Wrap wrap) {
        if (wrap == Texture::Wrap::clamp) return std::clamp(i, 0, n - 1);
        if (wrap == Texture::Wrap::repeat) return ((i % n) + n) % n;
        const int turn = ((i % (2 * n)) + 2 * n) % (2 * n);
        return turn < n ? turn : 2 * n - 1 - turn;
    }
    double texel(int l, int x, int y, int c) const {
        return code(l, wrapped(x, width_of(l), texture_.wrap_u), wrapped(y, height_of(l), texture_.wrap_v),
                    c) /
               (texture_.is_16_bit ? 65535.0 : 255.0);
    }
    double bilinear(int l, double u, double v, int c) const {
        const double x = u * width_of(l) - 0.5, y = v * height_of(l) - 0.5;
        const int i = int(std::floor(x)), j = int(std::floor(y));
        const double a = x - i, b = y - j;
        return (1 - a) * (1 - b) * texel(l, i, j, c) + a * (1 - b) * texel(l, i + 1, j, c) +
               (1 - a) * b * texel(l, i, j + 1, c) + a * b * texel(l, i + 1, j + 1, c);
    }

    std::mt19937 random_{7};
    Texture texture_;
    std::vector<std::byte> data_;
};

// Rounding: coordinates of up to 2.5 times 37 texels in single precision, 1e-5 of a texel, between codes that
// may be a whole range apart; the level errs by log2's 1e-6.
TEST(Samplers, TexturesAreFilteredAsOpenGLSays) {
    using enum Texture::Wrap;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1.5, 2.5), exponent(-9, 1), turn(0, 6.28);
    for (const auto& [u_wrap, v_wrap] : {std::pair(repeat, repeat), {mirror, clamp}, {clamp, mirror}})
        for (const bool is_16_bit : {false, true}) {
            const Levels levels(37, 20, u_wrap, v_wrap, is_16_bit);
            TextureReader reader;
            for (int i = 0; i < 2000; ++i) {
                // As single precision has them.
                const auto u = float(place(random)), v = float(place(random));
                const double size = std::exp2(exponent(random)), angle = turn(random);
                const double changes[4] = {double(float(size * std::cos(angle))),
                                           double(float(size * std::sin(angle))), double(float(size * 0.3)),
                                           double(float(size * -0.2))};
                const vec4 found =
                    reader.textureGrad(levels.texture(), {u, v}, {float(changes[0]), float(changes[1])},
                                       {float(changes[2]), float(changes[3])}, 0.25f);
                const float channels[4] = {found.x.v[0], found.y.v[0], found.z.v[0], found.w.v[0]};
                for (int c = 0; c < 4; ++c)
                    ASSERT_NEAR(channels[c], levels.expected(double(u), double(v), changes, 0.25, c), 3e-5)
                        << u << ' ' << v << ' ' << size;
            }
        }
}

}  // namespace
}  // namespace easypbr::native::checked
