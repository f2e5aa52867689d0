#include "easypbr/scene/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"

namespace easypbr::environment_test {
namespace {

/// An equirectangular picture of L(direction) at the centres of the pixels.
Image picture(int width, int height, const std::function<Vec3(const Vec3&)>& radiance) {
    Image image(width, height, 3, PixelType::f32);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            Eigen::Map<Vec3>(image.at<float>(x, y)) = radiance(
                equirect_direction((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height)));
    return image;
}

/// Directions that lie along no axis and in every octant.
std::vector<Vec3> probe_directions() {
    std::vector<Vec3> directions;
    for (const float x : {-0.6f, 0.0f, 0.9f})
        for (const float y : {-1.0f, 0.1f, 0.7f})
            for (const float z : {-0.8f, 0.3f, 1.1f}) directions.push_back(Vec3(x, y, z).normalized());
    return directions;
}

TEST(Equirect, AxesAreWhereTheHeaderSays) {
    // u = 0.5 is -Z, u grows towards +X, v = 0 is up. Tolerance: float sine and cosine of multiples of pi.
    EXPECT_LT((equirect_direction(0.5f, 0.5f) - Vec3(0, 0, -1)).norm(), 1e-6f);
    EXPECT_LT((equirect_direction(0.75f, 0.5f) - Vec3(1, 0, 0)).norm(), 1e-6f);
    EXPECT_LT((equirect_direction(0.25f, 0.5f) - Vec3(-1, 0, 0)).norm(), 1e-6f);
    EXPECT_LT((equirect_direction(0.0f, 0.5f) - Vec3(0, 0, 1)).norm(), 1e-6f);
    EXPECT_LT((equirect_direction(0.3f, 0.0f) - Vec3(0, 1, 0)).norm(), 1e-6f);
    EXPECT_LT((equirect_direction(0.3f, 1.0f) - Vec3(0, -1, 0)).norm(), 1e-6f);
}

TEST(Equirect, UvAndDirectionAreInverse) {
    for (const Vec3& direction : probe_directions()) {
        const Vec2 uv = equirect_uv(direction);
        EXPECT_GE(uv.minCoeff(), 0);
        EXPECT_LE(uv.maxCoeff(), 1);
        // A few roundings of angles up to pi: 4e-7 each.
        EXPECT_LT((equirect_direction(uv.x(), uv.y()) - direction).norm(), 2e-6f) << direction.transpose();
    }
}

TEST(Environment, EmptyOnesHaveNothing) {
    const Environment none;
    EXPECT_TRUE(none.empty());
    EXPECT_TRUE(none.image().empty());
    EXPECT_EQ(none.name(), "");
    EXPECT_EQ(none.hash(), "");
    EXPECT_FALSE(none.sun());
    EXPECT_TRUE(none.without_sun().empty());
    EXPECT_EQ(none.irradiance_over_pi(Vec3::UnitY()), Vec3(0, 0, 0));
}

TEST(Environment, ConstantRadianceIsItsOwnIrradianceOverPi) {
    // Pixels are integrated exactly, so that even 5 x 3 of them lose nothing; tolerance: float coefficients.
    const Environment environment(picture(5, 3, [](const Vec3&) { return Vec3(0.7f, 1.0f, 2.0f); }));
    for (const Vec3& n : probe_directions())
        EXPECT_LT((environment.irradiance_over_pi(n) - Vec3(0.7f, 1.0f, 2.0f)).norm(), 2e-6f);
}

TEST(Environment, LinearRadianceGivesTwoThirdsOfItsSlope) {
    // E(n) of L = 1 + k.w is pi + (2 pi / 3) k.n. The picture is constant within a pixel: the first harmonic
    // loses (pi / height)^2 / 6 and less, 2e-5 at 256 rows.
    for (const Vec3& k : {Vec3(0.5f, 0, 0), Vec3(0, 0.5f, 0), Vec3(0, 0, -0.5f), Vec3(0.3f, -0.2f, 0.4f)}) {
        const Environment environment(
            picture(512, 256, [&](const Vec3& w) { return Vec3(Vec3::Constant(1 + k.dot(w))); }));
        for (const Vec3& n : probe_directions())
            EXPECT_NEAR(environment.irradiance_over_pi(n).x(), 1 + 2.0f / 3 * k.dot(n), 5e-5f);
    }
}

TEST(Environment, QuadraticRadianceIsExactForEveryAxis) {
    // L = (w.a)^2: E(n) = pi/3 + (pi/6) P2(n.a) with P2(x) = (3 x^2 - 1) / 2; five slanted axes touch all
    // five coefficients of degree 2. Tolerance: the pixel's size as above, four times as large for the second
    // harmonic.
    for (const Vec3& axis :
         {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0, -1, 1), Vec3(1, 0.5f, -1)}) {
        const Vec3 a = axis.normalized();
        const Environment environment(
            picture(512, 256, [&](const Vec3& w) { return Vec3(Vec3::Constant(w.dot(a) * w.dot(a))); }));
        for (const Vec3& n : probe_directions()) {
            const float p2 = (3 * n.dot(a) * n.dot(a) - 1) / 2;
            EXPECT_NEAR(environment.irradiance_over_pi(n).x(), 1.0f / 3 + p2 / 6, 2e-4f);
        }
    }
}

TEST(Environment, HemisphereOfLightIsGoodToTwoPercent) {
    // L = max(0, w.z): E(n) = (2/3)(sin g + (pi - g) cos g) with g the angle between n and z (degrees above 2
    // are lost).
    const Environment environment(
        picture(256, 128, [](const Vec3& w) { return Vec3(Vec3::Constant(std::max(0.0f, w.z()))); }));
    for (const Vec3& n : probe_directions()) {
        const double g = std::acos(std::clamp(double(n.z()), -1.0, 1.0));
        const double expected = 2.0 / 3 * (std::sin(g) + (pi - g) * std::cos(g)) / pi;
        EXPECT_NEAR(environment.irradiance_over_pi(n).x(), expected, 0.02);
    }
}

TEST(Environment, IrradianceIsNeverNegative) {
    // One bright pixel: degree 2 rings to -4 % of the peak on the far side.
    Image image(64, 32, 3, PixelType::f32);
    image.at<float>(20, 15)[1] = 1000;
    const Environment environment(std::move(image));
    for (const Vec3& n : probe_directions()) EXPECT_GE(environment.irradiance_over_pi(n).minCoeff(), 0);
}

TEST(Environment, WhatIsNoRadianceBecomesZeroAndIsReported) {
    Image image(4, 2, 3, PixelType::f32);
    for (float& value : image.pixels<float>()) value = 1;
    image.at<float>(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
    image.at<float>(1, 0)[1] = std::numeric_limits<float>::infinity();
    image.at<float>(2, 1)[2] = -3;
    std::string message;
    set_log_sink([&](LogLevel level, std::string_view text) {
        if (level == LogLevel::warning) message = text;
    });
    const Environment environment(std::move(image), "sky.hdr");
    set_log_sink({});
    EXPECT_NE(message.find("sky.hdr"), std::string::npos) << message;
    EXPECT_NE(message.find("3 values"), std::string::npos) << message;
    EXPECT_EQ(environment.image().at<float>(0, 0)[0], 0);
    EXPECT_EQ(environment.image().at<float>(1, 0)[1], 0);
    EXPECT_EQ(environment.image().at<float>(2, 1)[2], 0);
    EXPECT_EQ(environment.image().at<float>(3, 1)[0], 1);
}

TEST(Environment, OtherPicturesAreConverted) {
    Image grey(2, 1, 1, PixelType::u8);
    grey.pixels<uint8_t>()[0] = 255;
    const Environment environment(grey);
    ASSERT_EQ(environment.image().channels(), 3);
    ASSERT_EQ(environment.image().type(), PixelType::f32);
    EXPECT_EQ(environment.image().at<float>(0, 0)[2], 1);
    EXPECT_EQ(environment.image().at<float>(1, 0)[2], 0);
}

TEST(Environment, EmptyPictureIsRefused) {
    EXPECT_THROW(Environment{Image()}, ArgumentError);
}

TEST(Environment, WithoutAPictureNothingIsLit) {
    const Environment environment;
    EXPECT_TRUE(environment.empty());
    EXPECT_EQ(environment.irradiance_over_pi(Vec3::UnitY()), Vec3(0, 0, 0));
}

TEST(Environment, HashTellsContentAndShapeApart) {
    const auto flat = [](int width, int height, float value) {
        return Environment(picture(width, height, [=](const Vec3&) { return Vec3(Vec3::Constant(value)); }),
                           "x")
            .hash();
    };
    EXPECT_EQ(flat(4, 2, 1), flat(4, 2, 1));
    EXPECT_NE(flat(4, 2, 1), flat(2, 4, 1));
    EXPECT_NE(flat(4, 2, 1), flat(4, 2, 2));
}

TEST(Studio, IsARoomWithBrightLampsAndDarkSurroundings) {
    const Image& image = studio_environment().image();
    ASSERT_EQ(image.width(), 1024);
    ASSERT_EQ(image.height(), 512);
    double sum = 0, weight = 0, peak = 0;
    for (int y = 0; y < image.height(); ++y) {
        const double row = std::cos(pi * y / 512) - std::cos(pi * (y + 1) / 512);
        for (int x = 0; x < image.width(); ++x) {
            const float* p = image.at<float>(x, y);
            const double luminance = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
            ASSERT_GT(luminance, 0);
            sum += row * luminance;
            weight += row;
            peak = std::max(peak, luminance);
        }
    }
    // What the lamps were designed for: a mean that needs no exposure, a peak that stands out of it.
    EXPECT_GT(sum / weight, 0.6);
    EXPECT_LT(sum / weight, 1.1);
    EXPECT_GT(peak, 10);
    EXPECT_LT(peak, 14);
    const auto from = [](const Vec3& n) { return studio_environment().irradiance_over_pi(n).y(); };
    EXPECT_GT(from(Vec3::UnitY()), 4 * from(-Vec3::UnitY())) << "light comes from above";
    EXPECT_GT(from(-Vec3::UnitX()), 1.5 * from(Vec3::UnitX())) << "the left side is the key side";
}

}  // namespace
}  // namespace easypbr::environment_test
