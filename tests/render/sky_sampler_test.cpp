// Directions and densities of skies as paths choose them.
#include "easypbr/render/raytrace/sky_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "easypbr/native/shaders.h"
#include "easypbr/render/raytrace/cdf.h"
#include "easypbr/render/raytrace/sky_place.h"

namespace easypbr::sky_sampler_test {

TEST(SkySampler, TheFastArcTangentIsTheArcTangent) {
    for (int i = -1000; i <= 1000; ++i) {
        const double angle = pi * i / 1000;
        const auto y = float(std::sin(angle)), x = float(std::cos(angle));
        // Its own error is 2e-8; the rest is rounding of angles up to pi.
        EXPECT_NEAR(render::fast_atan2(y, x), std::atan2(y, x), 5e-7) << angle;
    }
    EXPECT_EQ(render::fast_atan2(0, 0), 0);
}

TEST(SkySampler, PlacesAreThoseOfTheMap) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
        EXPECT_LT((render::sky_place(d) - equirect_uv(d)).cwiseAbs().maxCoeff(), 3e-7f);
    }
}

// Of many at once, turned: places as above; the way back ends at the direction. 2e-6: places are rounded to
// 6e-8 of a turn of 2 pi, and sines and cosines have an error of 3e-7.
TEST(SkySampler, ManyPlacesAndDirectionsAreThoseOfTheMap) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const Mat3 R = Eigen::AngleAxisf(0.7f, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
               back = R.transpose();
    float turn[3][3], turn_back[3][3];
    std::copy_n(R.data(), 9, turn[0]);
    std::copy_n(back.data(), 9, turn_back[0]);
    constexpr int count = 50;
    constexpr size_t room = 64;
    std::array<std::array<float, room>, 10> numbers{};
    auto& [x, y, z, u, v, cosines, sines, to_x, to_y, to_z] = numbers;
    for (size_t i = 0; i < count; ++i) {
        const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
        x[i] = d.x();
        y[i] = d.y();
        z[i] = d.z();
    }
    native::find_map_places(turn, {x.data(), y.data(), z.data()}, count, u.data(), v.data());
    for (size_t i = 0; i < count; ++i) {
        const Vec3 turned = R * Vec3(x[i], y[i], z[i]);
        EXPECT_LT((Vec2(u[i], v[i]) - equirect_uv(turned)).cwiseAbs().maxCoeff(), 4e-7f);
        cosines[i] = turned.y();
        sines[i] = Vec2(turned.x(), turned.z()).norm();
    }
    native::find_map_directions(turn_back, u.data(), cosines.data(), sines.data(), count,
                                {to_x.data(), to_y.data(), to_z.data()});
    for (size_t i = 0; i < count; ++i)
        EXPECT_LT((Vec3(to_x[i], to_y[i], to_z[i]) - Vec3(x[i], y[i], z[i])).norm(), 2e-6f);
}

TEST(SkySampler, AGuideChangesNoStep) {
    std::mt19937 random(2);
    for (const size_t count : {1, 2, 7, 64, 500}) {
        std::vector<float> ends;
        double sum = 0;
        for (size_t i = 0; i < count; ++i) {
            sum +=
                random() % 3 ? 0 : std::pow(double(random() % 1000), 4);  // many empty steps, few large ones
            ends.push_back(float(sum));
        }
        ends.back() += 1;
        for (float& end : ends) end /= ends.back();
        std::vector<uint16_t> guide;
        render::add_guide(ends, guide);
        for (int i = 0; i < 4096; ++i) {
            const float at = float(i) / 4096;
            float within = 0, guided = 0;
            const size_t step = render::step_of(ends, at, within);
            EXPECT_EQ(render::step_of(ends, guide, at, guided), step) << count << ", " << at;
            EXPECT_EQ(guided, within);
        }
    }
}

// A sample's density and radiance are those that are found in its direction, but beside borders of texels,
// and the densities are a distribution: their mean reciprocal is the solid angle that they cover.
TEST(SkySampler, SamplesAreWhatIsSeenInTheirDirection) {
    const int w = 96, h = 48;
    Image map(w, h, 3, PixelType::f32);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int c = 0; c < 3; ++c)
                map.at<float>(x, y)[c] = float((x * 7 + y * 13 + c) % 17) + (x == 40 ? 90.0f : 0.0f);
    const Environment environment(map, "test");
    const Mat3 R = Eigen::AngleAxisf(0.7f, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    render::SkySampler sky;
    sky.prepare(environment, R, 2);
    const int side = 128;
    std::vector<Vec2> points;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            points.emplace_back((float(i) + 0.5f) / float(side), (float(j) + 0.5f) / float(side));
    const auto samples = sky.sample(points);
    std::vector<Vec3> directions;
    for (const auto& sample : samples) directions.push_back(sample.direction);
    const auto all_seen = sky.seen(directions, std::vector<float>(directions.size(), 1.0f));
    int other = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
        EXPECT_NEAR(samples[i].direction.norm(), 1, 1e-6);
        const auto seen = sky.seen(directions[i], 1);
        other += samples[i].density != seen.density || samples[i].radiance != seen.radiance;
        EXPECT_EQ(seen.radiance, all_seen[i].radiance);
        EXPECT_EQ(seen.density, all_seen[i].density);
    }
    EXPECT_LE(other, side * side / 1000) << "single precision, beside borders";
    double integral = 0;
    const int rows = 6 * h, columns = 6 * w;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const float u = (float(x) + 0.5f) / float(columns), v = (float(y) + 0.5f) / float(rows);
            const double angle = 2 * pi / columns * (std::cos(pi * y / rows) - std::cos(pi * (y + 1) / rows));
            integral += angle * sky.seen(R.transpose() * equirect_direction(u, v), 1).density;
        }
    EXPECT_NEAR(integral, 1, 1e-4);
}

// What mirrors show is filtered linearly, as the background is, and goes on beyond the map's left and right.
// 0.02: places are rounded to 4e-7 of 96 texels, which differ by up to 200 each.
TEST(SkySampler, MirrorsSeeTheMapFilteredLinearly) {
    const int w = 96, h = 48;
    Image map(w, h, 3, PixelType::f32);
    std::mt19937 random(5);
    for (float& value : map.pixels<float>()) value = float(random() % 200);
    const Environment environment(map, "test");
    const Mat3 R = Eigen::AngleAxisf(0.7f, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    render::SkySampler sky;
    sky.prepare(environment, R, 2);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 500; ++i) {
        const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
        const Vec2d place = equirect_uv(R * d).cast<double>();
        const double x = place.x() * w - 0.5, y = place.y() * h - 0.5, left = std::floor(x),
                     above = std::floor(y);
        for (int c = 0; c < 3; ++c) {
            const auto texel = [&](double column, double row) {
                return double(map.at<float>((int(column) + w) % w, std::clamp(int(row), 0, h - 1))[c]);
            };
            const auto across = [&](double row) {
                return std::lerp(texel(left, row), texel(left + 1, row), x - left);
            };
            EXPECT_NEAR(sky.seen(d, 1e6f).radiance[c],
                        2 * std::lerp(across(above), across(above + 1), y - above), 0.02);
        }
    }
}

// A map of few texels lights as its picture looks, without edges between its texels: along the horizon from
// the middle of a texel of 1 to that of one of 9. 0.07: half of a step between 64 places that the way is
// divided in.
TEST(SkySampler, FewTexelsLightWithoutEdges) {
    const int w = 4, h = 2;
    Image map(w, h, 3, PixelType::f32);
    for (float& value : map.pixels<float>()) value = 1;
    for (int y = 0; y < h; ++y)
        for (int c = 0; c < 3; ++c) map.at<float>(2, y)[c] = 9;
    render::SkySampler sky;
    sky.prepare(Environment(map, "test"), Mat3::Identity(), 1);
    for (int i = 0; i <= 100; ++i) {
        const float part = float(i) / 100;
        const Vec3 direction = equirect_direction((1.5f + part) / w, 0.5f);
        for (const float density : {1.0f, 1e6f})  // a wide lobe's, a mirror's
            EXPECT_NEAR(sky.seen(direction, density).radiance.x(), 1 + 8 * part, 0.07) << part;
    }
}

// Of a sky whose radiance is the cosine from straight up, above its horizon: 2/3 on a surface that faces up,
// 2/(3 pi) on one that faces the horizon, nothing on one that faces down. 1e-4: sums over texels.
TEST(SkySampler, LightOnASurface) {
    const int w = 256, h = 128;
    Image map(w, h, 3, PixelType::f32);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int c = 0; c < 3; ++c)
                map.at<float>(x, y)[c] = std::max(0.0f, float(std::cos(pi * (y + 0.5) / h)));
    const Mat3 R = Eigen::AngleAxisf(0.7f, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    render::SkySampler sky;
    sky.prepare(Environment(map, "test"), R, 3);
    EXPECT_NEAR(sky.light_on(R.transpose() * Vec3(0, 1, 0)) / 3, 2 / 3.0, 1e-4);
    EXPECT_NEAR(sky.light_on(R.transpose() * Vec3(0, -1, 0)) / 3, 0, 1e-4);
    // The integral of sin^2 cos over the polar angle is 1/3, that of the cosine over half of the others 2.
    EXPECT_NEAR(sky.light_on(R.transpose() * Vec3(0, 0, 1)) / 3, 2 / (3 * pi), 1e-4);
}

}  // namespace easypbr::sky_sampler_test
