// Bloom against what must hold of any glow: it adds no light, stays where it is, and is round.

#include <cmath>
#include <cstring>
#include <limits>

#include "easypbr/render/effects/bloom/bloom_effect.h"
#include "easypbr/render/output/output_pass.h"
#include "easypbr/scene/resolve.h"
#include "render_test.h"

namespace easypbr::bloom_test {
namespace {

/// Light of a picture, one float for each pixel; and the pass alone over it, without the scene that would
/// make it.
struct LightField {
    int width, height;
    std::vector<float> values;

    LightField(int w, int h) : width(w), height(h), values(size_t(w) * size_t(h)) {}
    float& at(int x, int y) { return values[size_t(y) * size_t(width) + size_t(x)]; }
    float at(int x, int y) const { return values[size_t(y) * size_t(width) + size_t(x)]; }
    /// Between pixels, (0.5, 0.5) being the first one's centre.
    float between(double x, double y) const {
        const int i = int(std::floor(x - 0.5)), j = int(std::floor(y - 0.5));
        const float u = float(x - 0.5 - i), v = float(y - 0.5 - j);
        return (at(i, j) * (1 - u) + at(i + 1, j) * u) * (1 - v) +
               (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
    }
    double sum() const {
        double total = 0;
        for (float v : values) total += v;
        return total;
    }
    Vec2d centroid() const {
        Vec2d c(0, 0);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) c += at(x, y) * Vec2d(x + 0.5, y + 0.5);
        return c / sum();
    }
};

/// By the driver, or natively.
class BloomTest : public ::testing::TestWithParam<bool> {
  protected:
    BloomTest() : context_(gl::Context::create()) {
        resolved_.settings.bloom.enabled = true;
        resolved_.settings.bloom.intensity = 1;
        resolved_.settings.bloom.threshold = 0;
        resolved_.settings.bloom.suppress_fireflies = false;
        resolved_.settings.background.mode = BackgroundMode::transparent;
    }

    /// What is left of the picture when all of its light is spread: the glow at every pixel.
    LightField glow_of(const LightField& light, int levels) {
        const gl::ContextScope scope(*context_);
        const Vec2i size(light.width, light.height);
        resolved_.settings.bloom.levels = levels;
        render::Frame frame;
        frame.resolved = &resolved_;
        frame.size = frame.picture_size = size;
        frame.covered = {0, 0, size.x(), size.y()};
        const render::Target radiance(gl::Format::rgba32f, size);
        radiance.write(radiance.whole());
        for (size_t i = 0; i < light.values.size(); ++i)
            for (size_t c = 0; c < 4; ++c)
                radiance.pixels<float>()[4 * i + c] = c < 3 ? light.values[i] : 1.0f;
        render::Transfers transfers;
        if (!GetParam()) radiance.upload(transfers);
        render::BloomEffect bloom;
        render::LitPicture lit{.radiance = &radiance, .covered = frame.covered, .partly_covered = true};
        const render::GBuffer targets;
        const render::EffectInputs inputs{frame, targets, Box3d(), {}};
        GetParam() ? bloom.shade(inputs, lit, transfers) : bloom.draw(inputs, lit);
        render::OutputPass output(transfers);
        output.begin(size, render::Encoding::scene_linear, false);
        output.finish(frame, lit, nullptr, targets, nullptr);
        const std::vector<float> pixels = output.picture().read<float>(transfers);
        LightField result(size.x(), size.y());
        for (size_t i = 0; i < result.values.size(); ++i) result.values[i] = pixels[4 * i + 1];
        return result;
    }

    std::unique_ptr<gl::Context> context_;
    ResolvedSettings resolved_;
};

// Halves of 16 bits round by 0.05 %; the rest is left for the borders, which give back what they mirror.
TEST_P(BloomTest, KeepsTheEnergyAtAnySizeAndPlace) {
    for (const Vec2i& size : {Vec2i(333, 217), Vec2i(320, 180), Vec2i(1919, 1079), Vec2i(256, 128)})
        for (const Vec2d& part : {Vec2d(0.5, 0.5), Vec2d(0.37, 0.61), Vec2d(0.7, 0.3)})
            for (int levels : {1, 2, 3, 4, 5, 6}) {
                const int fitting = int(std::log2(size.minCoeff() / 16.0) + 0.5);
                if (levels > fitting) continue;  // What an automatic number of levels would be.
                LightField light(size.x(), size.y());
                light.at(int(part.x() * size.x()), int(part.y() * size.y())) = 1000;
                EXPECT_NEAR(glow_of(light, levels).sum(), 1000, 10)
                    << size.transpose() << " " << part.transpose() << " " << levels;
            }
}

// Light in the outermost pixels, in pictures smaller than a texel too. Where the border does not lie on the
// grid of the texels, its mirror image is only as exact as they are.
TEST_P(BloomTest, NeitherLosesNorMakesMuchLightAtTheBorders) {
    for (const Vec2i& size : {Vec2i(333, 217), Vec2i(17, 3), Vec2i(1, 1), Vec2i(255, 64)})
        for (const Vec2d& part : {Vec2d(0, 0), Vec2d(0.999, 0), Vec2d(0, 0.999), Vec2d(0.999, 0.999)})
            for (int levels : {1, 3, 6}) {
                LightField light(size.x(), size.y());
                light.at(int(part.x() * size.x()), int(part.y() * size.y())) = 1000;
                EXPECT_NEAR(glow_of(light, levels).sum(), 1000, 400)
                    << size.transpose() << " " << part.transpose() << " " << levels;
            }
}

TEST_P(BloomTest, LeavesAnEvenPictureAsItIs) {
    for (const Vec2i& size : {Vec2i(333, 217), Vec2i(1, 1), Vec2i(17, 3), Vec2i(64, 64)}) {
        LightField light(size.x(), size.y());
        for (float& v : light.values) v = 0.75f;
        for (float v : glow_of(light, 6).values) EXPECT_NEAR(v, 0.75f, 0.75f * 0.001f);
    }
}

// Far enough from the borders that all of the glow is in the picture: 3 levels reach 60 pixels.
TEST_P(BloomTest, StaysWhereItIs) {
    for (int shift = 0; shift < 16; ++shift) {
        LightField light(333, 217);
        light.at(160 + shift, 101 + shift / 2) = 1000;
        const Vec2d moved = glow_of(light, 3).centroid() - Vec2d(160.5 + shift, 101.5 + shift / 2);
        EXPECT_LT(moved.norm(), 0.1) << shift;
    }
}

TEST_P(BloomTest, IsRound) {
    LightField light(401, 401);
    light.at(200, 200) = 1e5f;
    const LightField glow = glow_of(light, 4);
    // Angular harmonics of the light around the source.
    for (int harmonic = 1; harmonic <= 8; ++harmonic) {
        Vec2d moment(0, 0);
        double sum = 0;
        for (int y = 0; y < 401; ++y)
            for (int x = 0; x < 401; ++x) {
                if (x == 200 && y == 200) continue;
                const double angle = harmonic * std::atan2(y - 200, x - 200);
                moment += glow.at(x, y) * Vec2d(std::cos(angle), std::sin(angle));
                sum += glow.at(x, y);
            }
        EXPECT_LT(moment.norm() / sum, 0.05) << harmonic;
    }
}

// Rings are even, too, wherever the source lies in its texel. They are measured at their radius exactly: the
// nearest pixels differ by how much the light falls within one, 6 % at the smallest. Nearer than four of the
// smallest texels their bilinear interpolation shows, by 7 % at 12 pixels.
TEST_P(BloomTest, HasEvenRings) {
    for (const int shift : {0, 1, 2, 3}) {
        LightField light(401, 401);
        light.at(200 + shift, 200 + shift / 2) = 1e5f;
        const LightField glow = glow_of(light, 4);
        for (const double radius : {16, 20, 24, 32, 40, 56}) {
            float least = 1e30f, most = 0;
            for (int i = 0; i < 64; ++i) {
                const double angle = i * pi / 32;
                const float value = glow.between(200.5 + shift + radius * std::cos(angle),
                                                 200.5 + shift / 2 + radius * std::sin(angle));
                least = std::min(least, value);
                most = std::max(most, value);
            }
            EXPECT_LT((most - least) / (most + least), 0.05f) << radius << " " << shift;
        }
    }
}

TEST_P(BloomTest, DoesNotFlickerWhenASourceMoves) {
    resolved_.settings.bloom.threshold = 1;
    std::vector<double> sums, peaks;
    for (int step = 0; step < 32; ++step) {
        // A bright square of 5 x 5 pixels that moves by a quarter of a pixel, anti-aliased.
        LightField light(320, 180);
        const double left = 150 + step / 4.0;
        for (int y = 80; y < 85; ++y)
            for (int x = 145; x < 175; ++x)
                light.at(x, y) =
                    float(40 * std::clamp(std::min(x + 1.0, left + 5) - std::max(double(x), left), 0.0, 1.0));
        const LightField glow = glow_of(light, 3);
        sums.push_back(glow.sum());
        peaks.push_back(glow.at(160, 120));
    }
    const auto [least, most] = std::ranges::minmax_element(sums);
    // The threshold takes less from the anti-aliased edge pixels: at most 1 of 40 from 5 of 25 pixels.
    EXPECT_LT((*most - *least) / *most, 0.02);
    for (size_t i = 1; i < peaks.size(); ++i) EXPECT_NEAR(peaks[i], peaks[i - 1], 0.05 * peaks[i]);
}

TEST_P(BloomTest, ContainsWhatIsNoNumber) {
    const float broken[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()};
    LightField light(160, 90);
    for (float& v : light.values) v = 0.5f;
    for (float value : broken) {
        light.at(77, 40) = value;
        const LightField glow = glow_of(light, 3);
        // One black pixel takes 1 of 16 from its texel.
        for (float v : glow.values) EXPECT_NEAR(v, 0.5f, 0.05f);
    }
}

TEST_P(BloomTest, SuppressesFireflies) {
    LightField light(160, 90);
    for (float& v : light.values) v = 0.2f;
    light.at(77, 40) = 1e4f;
    const double with = glow_of(light, 3).at(77, 45);
    resolved_.settings.bloom.suppress_fireflies = true;
    const double without = glow_of(light, 3).at(77, 45);
    EXPECT_GT(with, 5);
    EXPECT_LT(without, 0.4);
    // What is even over some pixels is no firefly.
    for (int y = 30; y < 60; ++y)
        for (int x = 60; x < 100; ++x) light.at(x, y) = 100;
    EXPECT_NEAR(glow_of(light, 1).at(80, 45), 100, 0.5);
}

// The soft knee: (l - t + k)^2 / 4k within k of the threshold t.
TEST_P(BloomTest, SpreadsWhatExceedsTheThreshold) {
    LightField half(64, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 32; ++x) half.at(x, y) = 1;
    const auto on_dark_side = [](const LightField& field) {
        double sum = 0;
        for (int x = 32; x < 64; ++x) sum += field.at(x, 32);
        return sum;
    };
    const double all = on_dark_side(glow_of(half, 1));
    EXPECT_GT(all, 0.5);
    resolved_.settings.bloom.threshold = 2;
    resolved_.settings.bloom.knee = 0.5f;
    const std::pair<float, float> expected[] = {
        {0.9f, 0.f}, {1.5f, 0.0625f}, {2.f, 0.25f}, {3.f, 1.f}, {5.f, 3.f}};
    for (const auto& [level, spread] : expected) {
        LightField light = half;
        for (float& v : light.values) v *= level;
        const LightField glow = glow_of(light, 1);
        EXPECT_NEAR(on_dark_side(glow), spread * all, 0.01 * all) << level;
        EXPECT_NEAR(glow.sum(), light.sum(), 0.01 * light.sum());
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, BloomTest, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "natively" : "by_driver"; });

TEST(Bloom, HoldsTheFurnaceAndAddsNothingToLayers) {
    Material white;
    white.base_color = Vec3::Ones();
    white.roughness = 0.5f;
    Scene scene;
    Mesh ball = make_sphere(1, 48);
    ball.set_material(white);
    scene.show(ball, "ball");
    scene.set_environment(constant_environment(0.5f));
    app::Session session = plain_session(scene, 97);
    session.settings().environment.enabled = true;
    session.settings().background.mode = BackgroundMode::environment;
    const Image before = render_linear(session, 4);
    const Image depth = session.render_layers({"depth"}).at("depth");
    session.settings().bloom.enabled = true;
    session.settings().bloom.threshold = 0;
    session.settings().bloom.intensity = 0.5f;
    const Image after = render_linear(session, 4);
    for (size_t i = 0; i < after.pixels<float>().size(); ++i)
        EXPECT_NEAR(after.pixels<float>()[i], before.pixels<float>()[i], 0.005f);
    EXPECT_EQ(std::memcmp(session.render_layers({"depth"}).at("depth").bytes().data(), depth.bytes().data(),
                          depth.bytes().size()),
              0);
}

// A glow over nothing covers as much of the background as it is bright; it never makes a picture darker
// there.
TEST(Bloom, GlowsOverATransparentBackground) {
    Material lamp;
    lamp.emissive = Vec3::Constant(50);
    Scene scene;
    scene.show(facing_square(0.3f, lamp), "lamp");
    app::Session session = plain_session(scene, 96);
    look_from(session, {0, 0, 6});
    session.settings().bloom.enabled = true;
    for (int samples : {1, 8}) {
        const Image picture = session.render({std::nullopt, samples});
        const uint8_t* beside = picture.at<uint8_t>(48, 20);
        EXPECT_GT(beside[3], 20) << samples;
        EXPECT_LT(beside[3], 250) << samples;
        EXPECT_GT(beside[1], 200) << samples;  // Straight alpha: the lamp's own white.
    }
    session.settings().background.mode = BackgroundMode::color;
    const Image with = session.render();
    session.settings().bloom.enabled = false;
    const Image without = session.render();
    for (int y = 0; y < 30; ++y) EXPECT_GE(with.at<uint8_t>(48, y)[1], without.at<uint8_t>(48, y)[1]) << y;
}

}  // namespace
}  // namespace easypbr::bloom_test
