#include "easypbr/scene/sun.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/environment.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::sun_test {
namespace {

Image picture(int width, const std::function<Vec3(const Vec3&)>& radiance) {
    Image image(width, width / 2, 3, PixelType::f32);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < width; ++x)
            Eigen::Map<Vec3>(image.at<float>(x, y)) = radiance(equirect_direction(
                (float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(image.height())));
    return image;
}

const Vec3 sun_at = Vec3(0.3f, 0.55f, -0.6f).normalized();

/// A blue sky over dark ground, and a disc of the given radius and radiance.
Image sky(double radius_deg, const Vec3& radiance) {
    return picture(1024, [&](const Vec3& d) -> Vec3 {
        if (d.dot(sun_at) >= std::cos(radians(radius_deg))) return radiance;
        return d.y() > 0 ? Vec3(0.4f, 0.6f, 1.0f) : Vec3(0.1f, 0.08f, 0.06f);
    });
}

/// Irradiance of a surface: the sum over all pixels, in double precision.
Vec3d irradiance(const Image& image, const Vec3d& normal) {
    Vec3d sum = Vec3d::Zero();
    for (int y = 0; y < image.height(); ++y) {
        const double top = pi * y / image.height(), bottom = pi * (y + 1) / image.height();
        const double solid_angle = (std::cos(top) - std::cos(bottom)) * 2 * pi / image.width();
        for (int x = 0; x < image.width(); ++x) {
            const Vec3 d = equirect_direction((float(x) + 0.5f) / float(image.width()),
                                              (float(y) + 0.5f) / float(image.height()));
            const double cosine = normal.dot(d.cast<double>());
            if (cosine > 0)
                sum += cosine * solid_angle * Eigen::Map<const Vec3>(image.at<float>(x, y)).cast<double>();
        }
    }
    return sum;
}

/// Irradiance before and after, on 100 normals spread over the sphere (Fibonacci lattice); but for surfaces
/// whose own plane comes nearer to the sun than an angle.
void expect_same_irradiance(const Image& image, const SunSplit& split, double left_out_deg = 0) {
    for (int i = 0; i < 100; ++i) {
        const double z = 1 - (i + 0.5) / 50, phi = i * pi * (3 - std::sqrt(5.0)), ring = std::sqrt(1 - z * z);
        const Vec3d n(ring * std::cos(phi), z, ring * std::sin(phi));
        const double cosine = n.dot(split.sun.towards.cast<double>());
        if (std::abs(degrees(std::asin(cosine))) < left_out_deg) continue;
        const Vec3d before = irradiance(image, n);
        const Vec3d after =
            irradiance(split.rest, n) + split.sun.irradiance.cast<double>() * std::max(0.0, cosine);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c] / before[c], 1, 0.01) << n.transpose();
    }
}

// A disc of radius a and radiance L over a sky of radiance B: the irradiance of what is taken is pi sin^2 a
// (L - B).
TEST(Sun, IsFoundWhereItStands) {
    const Vec3 radiance(9000, 8000, 6000);
    const Image image = sky(1, radiance);
    const auto split = split_sun(image);
    ASSERT_TRUE(split);
    // A pixel is 0.35 degrees wide; the disc of radius 1 degree is made of some 25 of them.
    EXPECT_LT(degrees(std::acos(std::min(1.0f, split->sun.towards.dot(sun_at)))), 0.1);
    EXPECT_NEAR(split->sun.angular_radius_deg, 1, 0.1);
    const double disc = pi * std::pow(std::sin(radians(1)), 2);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(split->sun.irradiance[c] / (disc * radiance[c]), 1, 0.05);
    float most = 0;
    for (const float v : split->rest.pixels<float>()) most = std::max(most, v);
    EXPECT_LT(most, 2.0f) << "the spot is as bright as the sky";
    // A hundred times as bright as all the sky, it stands on the horizon of one of the surfaces, which sees a
    // half.
    expect_same_irradiance(image, *split, 1);
}

TEST(Sun, ASoftOneToo) {
    // Brightness falls off as a Gaussian of 1.2 degrees.
    const Image image = picture(1024, [&](const Vec3& d) -> Vec3 {
        const double angle = degrees(std::acos(std::clamp(double(d.dot(sun_at)), -1.0, 1.0)));
        return Vec3(0.4f, 0.5f, 0.7f) + float(300 * std::exp(-angle * angle / 1.44)) * Vec3(1, 0.9f, 0.7f);
    });
    const auto split = split_sun(image);
    ASSERT_TRUE(split);
    // Mean squared angle of the Gaussian exp(-r^2 / s^2) is s^2, a disc's a^2 / 2.
    EXPECT_NEAR(split->sun.angular_radius_deg, 1.2 * std::sqrt(2.0), 0.25);
    expect_same_irradiance(image, *split);
}

TEST(Sun, IsNotSeenWhereThereIsNone) {
    EXPECT_FALSE(split_sun(picture(256, [](const Vec3&) { return Vec3(1, 1, 1); })));
    EXPECT_FALSE(split_sun(picture(256, [](const Vec3&) { return Vec3(0, 0, 0); })));
    EXPECT_FALSE(split_sun(studio_environment().image()));
    // As bright as a sun, but so small that it lights nothing: a star, a hot pixel.
    EXPECT_FALSE(split_sun(sky(0.2, Vec3(100, 100, 100))));
    // A window: bright, but as large as a fifth of the sky.
    EXPECT_FALSE(split_sun(sky(40, Vec3(100, 100, 100))));
}

TEST(Sun, OfARealPicture) {
    const char* data = std::getenv("EASYPBR_TEST_DATA");
    if (!data) GTEST_SKIP() << "EASYPBR_TEST_DATA names no folder";
    const Environment valley{std::filesystem::path(data) / "env/monument_valley.hdr"};
    ASSERT_TRUE(valley.sun());
    expect_same_irradiance(valley.image(), {*valley.sun(), valley.without_sun().image()});
    EXPECT_FALSE(Environment(std::filesystem::path(data) / "env/studio.hdr").sun());
}

TEST(Sun, BecomesALight) {
    Scene scene;
    scene.show(make_sphere(), "sphere");
    scene.set_environment(Environment(sky(1, Vec3(9000, 8000, 6000))));
    Settings settings;
    settings.environment.rotation_deg = 90;
    settings.environment.intensity = 2;
    ResolvedSettings resolved = resolve(scene.snapshot(), settings, Vec2i(64, 64));
    ASSERT_EQ(resolved.lights.size(), 1u);
    const ResolvedLight& light = resolved.lights[0];
    EXPECT_EQ(light.type, LightType::directional);
    const Vec3 towards = resolved.R_env_world * -light.direction;
    EXPECT_GT(towards.dot(sun_at), std::cos(radians(0.1)));
    EXPECT_NEAR(light.color.x() * light.intensity / 2, scene.environment().sun()->irradiance.x(), 1e-4);
    EXPECT_NE(resolved.environment.hash(), resolved.seen_environment.hash());
    EXPECT_EQ(resolved.seen_environment.hash(), scene.environment().hash());
    EXPECT_TRUE(resolved.settings.environment.sun);

    settings.environment.sun = false;
    resolved = resolve(scene.snapshot(), settings, Vec2i(64, 64));
    EXPECT_TRUE(resolved.lights.empty());
    EXPECT_EQ(resolved.environment.hash(), scene.environment().hash());
    settings.environment.sun = automatic;
    settings.environment.enabled = false;
    EXPECT_EQ(resolve(scene.snapshot(), settings, Vec2i(64, 64)).lights.size(), 1u) << "the key";
}

}  // namespace
}  // namespace easypbr::sun_test
