// Light of rare bright paths: none is lost, and it comes to rest where it is found.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "easypbr/render/raytrace/firefly_filter.h"
#include "render_test.h"

namespace easypbr::firefly_filter_test {
namespace {

using render::FireflyFilter;
using render::PathRadiance;

const Vec2i size(61, 46);

/// Pixels of a picture of `size`, row by row.
using Pixels = std::vector<Vec3>;

constexpr float most = 1000;  // more than any light here

size_t index_of(int x, int y) {
    return size_t(y) * size_t(size.x()) + size_t(x);
}

Vec3 sum_of(const Pixels& pixels) {
    return std::accumulate(pixels.begin(), pixels.end(), Vec3(0, 0, 0));
}

PathRadiance beyond(int x, int y, const Vec3& light) {
    PathRadiance radiance(size_t(size.prod()));
    radiance.beyond.assign(radiance.within.size(), Vec3::Zero());
    radiance.beyond[index_of(x, y)] = light;
    return radiance;
}

/// What pixels have after a frame: what stays where it was found, and what is spread.
template <class Reflectance>
Pixels drawn(FireflyFilter& filter, PathRadiance radiance, Reflectance&& reflectance) {
    filter.begin_frame(size, most);
    filter.take({0, 0, size.x(), size.y()}, radiance);
    Pixels pixels = radiance.within;
    const auto reflect = [&](int y, std::span<Vec3> row) {
        for (size_t x = 0; x < row.size(); ++x) row[x] = reflectance(int(x), y);
    };
    filter.spread(reflect, [&](int y, std::span<const Vec3> light) {
        for (size_t x = 0; x < light.size(); ++x) pixels[index_of(int(x), y)] += light[x];
    });
    return pixels;
}

/// Red and green halves, a hole, and rows without a surface above.
Vec3 patchwork(int x, int y) {
    if (y < 3 || (x > 12 && x < 16 && y < 12)) return Vec3::Zero();
    return x < 20 ? Vec3(0.9f, 0.1f, 0.05f) : Vec3(0.05f, 0.6f, 0.2f);
}

// At corners, edges and beside holes too. 1e-5: single precision adds up hundreds of pixels.
TEST(FireflyFilter, LosesNoLight) {
    const Vec3 light(8, 4, 2);
    for (const Vec2i& at : {Vec2i(0, 3), Vec2i(60, 45), Vec2i(11, 5), Vec2i(19, 12), Vec2i(17, 3)}) {
        FireflyFilter filter;
        const Pixels pixels = drawn(filter, beyond(at.x(), at.y(), light), patchwork);
        EXPECT_TRUE(sum_of(pixels).isApprox(light, 1e-5f)) << at.transpose() << ": " << sum_of(pixels);
        for (int y = 0; y < size.y(); ++y)
            for (int x = 0; x < size.x(); ++x)
                EXPECT_TRUE(!patchwork(x, y).isZero() || pixels[index_of(x, y)].isZero()) << x << ' ' << y;
    }
}

// Of light in the square of pixels 16 to 19, what comes to places between its middle, 18, and that of the
// next square, 22. The kernel is binomial over squares, and linear between their middles.
double kernel_at(double x) {
    const double part = (x - 18) / 4;
    return 0.375 * (1 - part) + 0.25 * part;
}

// Neighbours get it in proportion to their reflectance: red light stays on the red half.
TEST(FireflyFilter, GoesByReflectance) {
    FireflyFilter filter;
    const Pixels pixels = drawn(filter, beyond(19, 12, Vec3(1, 1, 1)), patchwork);
    const Vec3 left = pixels[index_of(18, 12)], right = pixels[index_of(20, 12)];
    const double by_place = kernel_at(18.5) / kernel_at(20.5);
    EXPECT_GT(left.x(), 0.005f);
    EXPECT_NEAR(left.x() / right.x(), 0.9 / 0.05 * by_place, 1e-3);
    EXPECT_NEAR(left.y() / right.y(), 0.1 / 0.6 * by_place, 1e-5);
}

// 1/17 stays: a pixel is expected to have found 1/16 of the path. Where reflectance is even, the rest of each
// square's light, 16/17, goes to 16 pixels' worth of places.
TEST(FireflyFilter, SpreadsByTheKernel) {
    FireflyFilter filter;
    const Pixels pixels =
        drawn(filter, beyond(18, 10, Vec3(1, 1, 1)), [](int, int) { return Vec3(1, 1, 1); });
    EXPECT_NEAR(pixels[index_of(18, 10)].x(), (1 + kernel_at(18.5) * kernel_at(18.5)) / 17, 1e-6);
    EXPECT_NEAR(pixels[index_of(21, 10)].x(), kernel_at(21.5) * kernel_at(18.5) / 17, 1e-6);
    EXPECT_GT(pixels[index_of(28, 10)].x(), 0);
    EXPECT_EQ(pixels[index_of(30, 10)].x(), 0);
}

// A pixel's light does not depend on those beyond `reach`, whatever is there.
TEST(FireflyFilter, ReachesNoFarther) {
    const auto reflectance = [](int x, int) { return Vec3::Constant(x < 10 ? 0.2f : 0.9f).eval(); };
    for (int x = 0; x < size.x(); ++x) {
        FireflyFilter one, other;
        const Pixels near = drawn(one, beyond(x, 8, Vec3(1, 1, 1)), reflectance);
        const Pixels changed = drawn(other, beyond(x, 8, Vec3(1, 1, 1)), [&](int column, int y) {
            return Vec3(column == 0 ? Vec3(0.4f, 0.4f, 0.4f) : reflectance(column, y));
        });
        for (int column = FireflyFilter::reach + 1; column < size.x(); ++column)
            EXPECT_EQ(near[index_of(column, 8)], changed[index_of(column, 8)]) << x << " to " << column;
    }
}

// What is found again and again comes to stay: after n frames a pixel is expected to have found n / 16 such
// paths.
TEST(FireflyFilter, KeepsWhatIsFoundOften) {
    FireflyFilter filter;
    const auto even = [](int, int) { return Vec3(1, 1, 1); };
    for (int frame = 1; frame <= 200; ++frame) {
        const Pixels pixels = drawn(filter, beyond(18, 10, Vec3(2, 2, 2)), even);
        const double paths = frame / 16.0, stays = paths / (1 + paths);
        const double of_spread = std::pow(kernel_at(18.5), 2) / 16;
        EXPECT_NEAR(pixels[index_of(18, 10)].x(), 2 * (stays + (1 - stays) * of_spread), 1e-4) << frame;
    }
    // Of a path a hundred times as bright 3 / 16 are expected now, with its own light: of them 0.158 stays.
    const Pixels bright = drawn(filter, beyond(18, 10, Vec3(200, 200, 200)), even);
    EXPECT_NEAR(bright[index_of(18, 10)].x(), 200 * 0.158, 200 * 0.01);  // of what is spread 0.006
    filter.begin_picture();
    EXPECT_NEAR(drawn(filter, beyond(18, 10, Vec3(2, 2, 2)), even)[index_of(18, 10)].x(),
                2 * (1 + std::pow(kernel_at(18.5), 2)) / 17, 1e-5);
}

void white(int, std::span<Vec3> row) {
    std::ranges::fill(row, Vec3(1, 1, 1));
}

// Of light that would show as a spot 1/17 stays where it is found, 3 is spread, and the rest is lost.
TEST(FireflyFilter, SpreadsNoMoreThanIsAllowed) {
    FireflyFilter filter;
    filter.begin_frame(size, 3);
    PathRadiance radiance = beyond(18, 10, Vec3(12, 12, 12));
    filter.take({0, 0, size.x(), size.y()}, radiance);
    Pixels pixels = radiance.within;
    filter.spread(white, [&](int y, std::span<const Vec3> light) {
        for (size_t x = 0; x < light.size(); ++x) pixels[index_of(int(x), y)] += light[x];
    });
    EXPECT_NEAR(sum_of(pixels).x(), 3 + 12.0 / 17, 1e-5);
}

Mesh wall(const Vec3& towards, const Vec3& at, const Material& material, float half = 1) {
    Mesh mesh = facing_square(half, material);
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Vec3d(0, 0, 1), towards.cast<double>()).toRotationMatrix();
    pose.translation() = at.cast<double>();
    mesh.set_T_world_mesh(pose);
    return mesh;
}

Material matt(float color) {
    Material material;
    material.base_color = Vec3::Constant(color);
    material.roughness = 1;
    return material;
}

Mesh lamp(float x, float towards, float radiance) {
    Material bright = matt(0);
    bright.emissive = Vec3::Constant(radiance);
    return wall(Vec3(towards, 0, 0), Vec3(x, 0, 0.5f), bright, 0.1f);
}

/// A matt wall that a small lamp lights, and again by way of a mirror: paths from the wall find that by
/// chance alone.
struct Mirrored {
    explicit Mirrored(float radiance = 4) {
        Material mirror = matt(1);
        mirror.metallic = 1;
        mirror.roughness = 0;
        scene.show(wall(Vec3(0, 0, 1), Vec3(0, 0, 0), matt(0.8f)), "wall");
        scene.show(wall(Vec3(-1, 0, 0), Vec3(1, 0, 1), mirror), "mirror");
        scene.show(lamp(-0.99f, 1, radiance), "lamp");
    }
    app::Session session(float clamp) const {
        app::Session session = plain_session(scene, 64);
        Settings& s = session.settings();
        s.path.enabled = true;
        s.path.denoise = Denoising::off;
        s.path.clamp = clamp;
        s.path.bounces = 1;
        s.shadows.enabled = true;
        look_from(session, Vec3d(0, 0, 4), 28);
        return session;
    }
    Image picture(float clamp, int samples) const {
        app::Session of = session(clamp);
        return render_linear(of, samples);
    }
    /// The same light by a lamp where the mirror shows it, which rays find.
    Image reference() const {
        Mirrored other;
        other.scene.remove("mirror");
        other.scene.show(lamp(2.99f, -1, 4), "image");
        app::Session of = other.session(0);
        of.settings().path.bounces = 0;
        return render_linear(of, 256);
    }
    Scene scene;
};

double mean(const Image& image) {
    const auto values = image.pixels<float>();
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double root_mean_square(const Image& a, const Image& b) {
    double sum = 0;
    const auto x = a.pixels<float>(), y = b.pixels<float>();
    for (size_t i = 0; i < x.size(); ++i) sum += std::pow(double(x[i]) - double(y[i]), 2);
    return std::sqrt(sum / double(x.size()));
}

// Paths by way of the mirror bring 3.2. 0.6 of it stays at its pixel, of the rest a part that grows, and what
// remains is spread. The same paths: the mean stays what it was, but for the rounding of sums in single
// precision. The error is below a third, that of 9 times as many samples, and goes on falling as light comes
// to stay.
TEST(Fireflies, AreSpreadWithoutLossOfLight) {
    const Mirrored mirrored;
    const Image reference = mirrored.reference(), noisy = mirrored.picture(0, 16),
                spread = mirrored.picture(0.6f, 16), many = mirrored.picture(0.6f, 256);
    EXPECT_NEAR(mean(mirrored.picture(0, 4096)) / mean(reference), 1, 0.005);
    EXPECT_NEAR(mean(spread) / mean(noisy), 1, 1e-5);
    EXPECT_LT(root_mean_square(spread, reference), root_mean_square(noisy, reference) / 3);
    EXPECT_LT(root_mean_square(many, reference), 0.5 * root_mean_square(spread, reference));
}

// Mirrors show what they face as it is: light that no matt surface has passed on is never spread.
TEST(Fireflies, AreNoneInMirrors) {
    Scene scene;
    Material mirror = matt(1), bright = matt(0);
    mirror.metallic = 1;
    mirror.roughness = 0;
    bright.emissive = Vec3(40, 40, 40);
    scene.show(wall(Vec3(0, 0, 1), Vec3(0, 0, 0), mirror), "mirror");
    scene.show(wall(Vec3(0, 0, -1), Vec3(0, 0, 6), bright, 0.5f), "lamp");
    const auto picture = [&](float clamp) {
        app::Session session = plain_session(scene, 64);
        session.settings().path.enabled = true;
        session.settings().path.denoise = Denoising::off;
        session.settings().path.clamp = clamp;
        look_from(session, Vec3d(0, 0, 4), 28);
        return render_linear(session, 4);
    };
    const Image with = picture(0.25f), without = picture(0);
    EXPECT_GT(mean(with), 1);
    EXPECT_TRUE(std::ranges::equal(with.bytes(), without.bytes()));
}

// Exposure comes first: a scene in other units looks the same.
TEST(Fireflies, AreBrightAsExposed) {
    const Mirrored mirrored, dim(4.0f / 64);
    app::Session a = mirrored.session(0.25f), b = dim.session(0.25f);
    b.settings().tonemap.exposure = 64.0f;
    const Image of_a = render_linear(a, 8), of_b = render_linear(b, 8);
    // Single precision, but for the exposure.
    for (size_t i = 0; i < of_a.pixel_count() * 4; ++i) {
        const float one = of_a.pixels<float>()[i], other = of_b.pixels<float>()[i] * (i % 4 == 3 ? 1 : 64);
        ASSERT_NEAR(other, one, 1e-4 * std::max(1.0f, one)) << i;
    }
}

}  // namespace
}  // namespace easypbr::firefly_filter_test
