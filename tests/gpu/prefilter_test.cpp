#include "easypbr/gpu/prefilter.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "easypbr/gpu/cube_map.h"

namespace easypbr::gpu::prefilter_test {
namespace {

float value(uint16_t half) {
    return Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(half));
}

template <class Function>
Environment environment_of(int width, Function&& radiance) {
    Image image(width, width / 2, 3, PixelType::f32);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3 d = equirect_direction((float(x) + 0.5f) / float(width),
                                              (float(y) + 0.5f) / float(image.height()));
            const Vec3 v = radiance(d);
            std::copy_n(v.data(), 3, image.at<float>(x, y));
        }
    return Environment(image);
}

TEST(CubeMap, DirectionsAndSamplesAgree) {
    CubeMap cube(8);
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) cube.at(face, x, y).head<3>() = cube.direction(face, x, y);
    cube.fill_gutter();
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                const Vec3 d = cube.direction(face, x, y);
                // The value at a texel's centre is the texel.
                EXPECT_LT((cube.sample(d).head<3>() - d).norm(), 1e-5);
            }
}

// A constant environment stays constant at every level: all weights are normalised.
TEST(Prefilter, KeepsAConstant) {
    const PrefilteredEnvironment maps =
        prefilter(environment_of(64, [](const Vec3&) { return Vec3(0.7f, 0.7f, 0.7f); }));
    const auto expect_constant = [](const std::vector<uint16_t>& halves) {
        for (size_t i = 0; i < halves.size(); i += 4)
            ASSERT_NEAR(value(halves[i]), 0.7f, 0.0005f);  // half: 11 bits
    };
    for (const auto& level : maps.radiance) expect_constant(level);
    expect_constant(maps.irradiance);
}

// Halves hold 2^-14 to 65504: a power of two brings what is beyond into the range, without a rounding.
TEST(Prefilter, ScalesWhatHalvesDoNotHold) {
    const auto maps_of = [](float radiance) {
        return prefilter(environment_of(64, [=](const Vec3&) { return Vec3::Constant(radiance); }));
    };
    const PrefilteredEnvironment usual = maps_of(0.7f);
    EXPECT_EQ(usual.scale, 1);
    for (const float factor : {0x1p-30f, 0x1p30f}) {
        const PrefilteredEnvironment maps = maps_of(0.7f * factor);
        EXPECT_EQ(std::exp2(std::round(std::log2(maps.scale))), maps.scale);
        for (size_t i = 0; i < maps.irradiance.size(); i += 4)
            ASSERT_NEAR(value(maps.irradiance[i]) * maps.scale, 0.7f * factor, 0.0005f * factor);
    }
}

// L = 1 + k.w gives E / pi = 1 + (2/3) k.n exactly.
TEST(Prefilter, IrradianceOfALinearEnvironment) {
    const Vec3 k(0.3f, -0.5f, 0.2f);
    const PrefilteredEnvironment maps =
        prefilter(environment_of(256, [&](const Vec3& w) { return Vec3::Constant(1 + k.dot(w)); }));
    const int n = PrefilteredEnvironment::irradiance_size;
    for (int i = 0; i < 6 * n * n; ++i) {
        const CubeMap shape(n);
        const Vec3 normal = shape.direction(i / (n * n), i % n, i / n % n);
        // 32 x 32 texels per face and halves: the required bound for irradiance is 0.5 %.
        EXPECT_NEAR(value(maps.irradiance[size_t(i) * 4]), 1 + 2.0f / 3 * k.dot(normal), 0.004f);
    }
}

// Each level keeps the total power: a blur moves light, it neither adds nor takes any.
TEST(Prefilter, KeepsThePower) {
    const PrefilteredEnvironment maps = prefilter(environment_of(512, [](const Vec3& w) {
        return Vec3::Constant(w.dot(Vec3(0.6f, 0.64f, 0.48f)) > 0.9f ? 20.0f : 0.5f);
    }));
    const auto mean = [](const std::vector<uint16_t>& halves, int n) {
        double sum = 0, weight = 0;
        for (int i = 0; i < 6 * n * n; ++i) {
            const double u = (i % n + 0.5) * 2 / n - 1, v = (i / n % n + 0.5) * 2 / n - 1;
            const double w = 1 / std::pow(1 + u * u + v * v, 1.5);
            sum += w * value(halves[size_t(i) * 4]);
            weight += w;
        }
        return sum / weight;
    };
    const double reference = mean(maps.radiance[0], 256);
    for (int level = 1; level < PrefilteredEnvironment::level_count; ++level)
        // The NoL weight of Karis's sum keeps the power only roughly; 2 % is what 64 to 1024 samples give
        // here.
        EXPECT_NEAR(mean(maps.radiance[size_t(level)], 256 >> level) / reference, 1.0, 0.02) << level;
}

TEST(Prefilter, LevelsSpanAllRoughness) {
    EXPECT_EQ(roughness_of_level(0), 0.0f);
    EXPECT_EQ(roughness_of_level(PrefilteredEnvironment::level_count - 1), 1.0f);
}

}  // namespace
}  // namespace easypbr::gpu::prefilter_test
