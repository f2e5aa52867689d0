// Blended surfaces that are lit by paths.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <fmt/format.h>

#include "render_test.h"

#include "easypbr/scene/material_table.h"

namespace easypbr::path_layers_test {
namespace {

Material blended(float color, float opacity) {
    Material m;
    m.base_color = Vec3::Constant(color);
    m.metallic = 0;
    m.roughness = 1;
    m.opacity = opacity;
    return m;
}

/// Of paths without a bias, under an even sky of radiance 1.
app::Session session_under_sky(Scene& scene, int size) {
    scene.set_environment(constant_environment(1));
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.path.clamp = 0;
    s.path.bounces = 64;
    s.environment.enabled = true;
    return session;
}

void show_ball(Scene& scene, const Material& material, float radius, const std::string& name) {
    Mesh ball = make_sphere(radius, 64);
    ball.set_material(material);
    scene.show(ball, name);
}

/// Mean radiance over the pixels, which are wholly covered.
double mean_of_middle(const Image& image) {
    double sum = 0;
    const int from = image.width() / 2 - 4, to = from + 8;
    for (int y = from; y < to; ++y)
        for (int x = from; x < to; ++x) sum += image.at<float>(x, y)[0];
    return sum / 64;
}

/// Black and without end, beside what is near the origin.
Mesh black_wall() {
    Mesh wall = facing_square(40, blended(0, 1));
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.linear() = Eigen::AngleAxisd(pi / 2, Vec3d::UnitY()).toRotationMatrix();
    pose.translation() = Vec3d(-0.05, 0, 40);
    wall.set_T_world_mesh(pose);
    return wall;
}

// On a floor beside a black wall without end a half of the sky arrives, and the floor shows a half of that: a
// quarter, and covers a half. 0.01: 1024 samples of one pixel. The raster frame does not know of the wall.
TEST(PathLayers, SkyBesideAWall) {
    for (const bool native : {true, false}) {
        Scene scene;
        scene.show(facing_square(1, blended(1, 0.5f)), "floor");
        scene.show(black_wall(), "wall");
        app::Session session = session_under_sky(scene, 3);
        session.allow_native_geometry(native);
        session.settings().shading.dielectric_f0 = 0;
        look_from(session, Vec3d(0, 0, 5), 0.02f * 57);
        const Image image = render_linear(session, 1024);
        EXPECT_NEAR(image.at<float>(1, 1)[0], 0.25, 0.01) << native;
        EXPECT_NEAR(image.at<float>(1, 1)[3], 0.5, 1e-3) << native;
    }
}

// Surfaces that reflect all of an even sky disappear in it, however much they cover: four layers around an
// opaque ball. 0.005: roundings of the table of directional albedos, and the noise of 256 samples.
TEST(PathLayers, WhiteFurnace) {
    for (const float clearcoat : {0.0f, 1.0f}) {
        Scene scene;
        Material shell = blended(1, 0.6f);
        shell.clearcoat = clearcoat;
        show_ball(scene, blended(1, 1), 0.5f, "core");
        show_ball(scene, shell, 0.8f, "inner");
        show_ball(scene, shell, 1, "outer");
        app::Session session = session_under_sky(scene, 32);
        look_from(session, Vec3d(0, 0, 5), 20);
        EXPECT_NEAR(mean_of_middle(render_linear(session, 256)), 1, 0.005) << clearcoat;
    }
}

// A white surface behind a black one that covers a half: a half of the sky reaches it, of which a half is
// seen. 0.01: light that comes in from the sides.
TEST(PathLayers, LightPassesByOpacity) {
    Scene scene;
    Mesh behind = facing_square(10, blended(1, 1));
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.translation() = Vec3d(0, 0, -0.05);
    behind.set_T_world_mesh(pose);
    scene.show(behind, "behind");
    scene.show(facing_square(10, blended(0, 0.5f)), "front");
    app::Session session = session_under_sky(scene, 32);
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, Vec3d(0, 0, 5), 20);
    EXPECT_NEAR(mean_of_middle(render_linear(session, 256)), 0.25, 0.01);
}

/// Mean distance of the colours on a white page, of 255: what is hardly covered has any colour.
double apart(const Image& a, const Image& b) {
    const auto shown = [](const Image& image, size_t pixel, size_t c) {
        const uint8_t* code = image.pixels<uint8_t>().data() + 4 * pixel;
        return 255 - (255 - code[c]) * code[3] / 255.0;
    };
    double sum = 0;
    const size_t pixels = a.bytes().size() / 4;
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) sum += std::abs(shown(a, i, c) - shown(b, i, c));
    return sum / double(3 * pixels);
}

// Each of several objects takes its part of light from all sides, faces of the same number, too. 0.016: four
// deviations of 64 pixels of 256 samples, each of which arrives or not.
TEST(PathLayers, LightPassesSeveralObjectsInTurn) {
    for (int count = 1; count <= 3; ++count) {
        Scene scene;
        Material white = blended(1, 1);
        white.specular = 0;
        scene.show(facing_square(50, white), "floor");
        for (int i = 0; i < count; ++i) {
            Material filter = blended(0, 0.5f);
            filter.specular = 0;
            Mesh layer = facing_square(50, filter);
            layer.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 2 + i)));
            scene.show(layer, fmt::format("filter {}", i));
        }
        app::Session session = session_under_sky(scene, 16);
        look_from(session, Vec3d(0, -1, 1), 20);
        EXPECT_NEAR(mean_of_middle(render_linear(session, 256)), std::pow(0.5, count), 0.016) << count;
    }
}

/// Two layers of opacity 0.3 that are nearer to each other than a pixel of 16 is wide.
double mean_of_two_layers(float specular, int size) {
    Material matt = blended(0.8f, 0.3f);
    matt.specular = specular;
    Scene scene;
    scene.show(facing_square(20, matt), "front");
    Mesh behind = facing_square(20, matt);
    behind.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -0.05)));
    scene.show(behind, "behind");
    app::Session session = session_under_sky(scene, size);
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, Vec3d(0, 0, 5), 30);
    return mean_of_middle(render_linear(session, 512));
}

// What a layer gets does not depend on the size of a pixel. The front one gets all of the sky's light. The
// other one gets e = 0.7 + 0.24 (0.24 e + 0.7): what passes the front, and what comes back to it from there.
// 0.002: four deviations.
TEST(PathLayers, LayersWithinAPixelAreLitInTurn) {
    const double e = 0.7 * 1.24 / (1 - 0.24 * 0.24);
    EXPECT_NEAR(mean_of_two_layers(0, 16), 0.24 + 0.7 * 0.24 * e, 0.002);
    EXPECT_NEAR(mean_of_two_layers(1, 16), mean_of_two_layers(1, 128), 0.002);
}

// Half of the noisy picture's error at most, of light and of what is covered: a shadow that the ground
// catches is seen through the ball.
TEST(PathLayers, DenoisedPicturesAreCloser) {
    Scene scene;
    show_ball(scene, blended(0.5f, 0.3f), 1, "ball");
    app::Session session = session_under_sky(scene, 64);
    session.settings().ground.mode = GroundMode::shadow;
    const auto drawn = [&](Denoising denoise, int samples) {
        session.settings().path.denoise = denoise;
        return session.render({std::nullopt, samples});
    };
    const Image reference = drawn(Denoising::off, 1024), noisy = drawn(Denoising::off, 8),
                denoised = drawn(Denoising::filter, 8);
    EXPECT_LT(apart(denoised, reference), apart(noisy, reference) / 2);
}

/// A square with noise in the alpha of its texture, a texel a pixel or two.
Mesh grainy_square() {
    constexpr int side = 64;
    Image image(side, side, 4, PixelType::u8);
    uint32_t state = 1;
    for (uint8_t& code : image.pixels<uint8_t>()) {
        state = state * 1664525u + 1013904223u;
        code = uint8_t(state >> 24);
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) std::fill_n(image.at<uint8_t>(x, y), 3, uint8_t(200));
    Material m = blended(1, 1);
    m.alpha_mode = AlphaMode::blend;
    m.base_color_texture.image = std::make_shared<Image>(image);
    return facing_square(1, m);
}

/// The greatest difference of coverage, of 255.
int alphas_apart(const Image& a, const Image& b) {
    int most = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            most = std::max(most, std::abs(a.at<uint8_t>(x, y)[3] - b.at<uint8_t>(x, y)[3]));
    return most;
}

// No path finds by chance what a texture covers: samples without the denoiser have the same coverage, but for
// a last step of its rounding. The light of the surface is even, and its error no more than theirs; over a
// sky too, which is no surface.
TEST(PathLayers, DenoisingKeepsTexturesOfOpacity) {
    Scene scene;
    scene.show(grainy_square(), "square");
    app::Session session = session_under_sky(scene, 64);
    look_from(session, Vec3d(0, 0, 5), 30);
    const auto drawn = [&](Denoising denoise, int samples) {
        session.settings().path.denoise = denoise;
        return session.render({std::nullopt, samples});
    };
    for (const BackgroundMode background : {BackgroundMode::transparent, BackgroundMode::environment}) {
        session.settings().background.mode = background;
        const Image reference = drawn(Denoising::off, 256), noisy = drawn(Denoising::off, 8),
                    denoised = drawn(Denoising::filter, 8);
        EXPECT_LE(alphas_apart(denoised, noisy), 1);
        EXPECT_LT(apart(denoised, reference), apart(noisy, reference));
    }
}

/// An unlit square whose colour is that of a label: exact.
Mesh labelled_square(float z) {
    Mesh mesh = facing_square(1);
    mesh.set_L(Array1i(Array1i::Dense::Constant(4, 1)));
    Style style;
    style.lit = false;
    mesh.set_style(style);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, z)));
    return mesh;
}

/// `front` at z = 0 before an exact colour.
app::Session session_before_label(const Material& front, Scene& scene) {
    scene.show(labelled_square(-0.05f), "labelled");
    scene.show(facing_square(1, front), "front");
    app::Session session = session_under_sky(scene, 32);
    look_from(session, Vec3d(0, 0, 5), 0.02f * 57);
    return session;
}

struct Spread {
    double mean = 0, deviation = 0;
};

constexpr int spread_side = 16;

/// Of a channel over the pixels in the middle.
Spread spread_of(const Image& image, int channel) {
    double sum = 0, squares = 0;
    const int from = image.width() / 2 - spread_side / 2, to = from + spread_side;
    for (int y = from; y < to; ++y)
        for (int x = from; x < to; ++x) {
            const double value = image.at<float>(x, y)[channel];
            sum += value;
            squares += value * value;
        }
    const double count = spread_side * spread_side, mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

// As in SkyBesideAWall, a quarter and one half of the colour behind. A path brings 0 to 1, of which a half is
// seen: a deviation of 0.25 at most, and four of them in a mean of 256 pixels.
TEST(PathLayers, LightBeforeExactColors) {
    Scene bare;
    bare.show(labelled_square(0), "labelled");
    app::Session plain = plain_session(bare, 32);
    look_from(plain, Vec3d(0, 0, 5), 20);
    const Image label = render_linear(plain);
    for (const bool native : {true, false})
        for (const int samples : {1, 4}) {
            Scene scene;
            scene.show(black_wall(), "wall");
            app::Session session = session_before_label(blended(1, 0.5f), scene);
            session.settings().shading.dielectric_f0 = 0;
            session.allow_native_geometry(native);
            const Image image = render_linear(session, samples);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(spread_of(image, c).mean, 0.25 + 0.5 * label.at<float>(16, 16)[c],
                            4 * 0.25 / spread_side)
                    << native << ", " << samples << " samples, channel " << c;
        }
}

// The deviation of a mean of n samples is that of one by the root of n, or less. 1.2: the deviation of 256
// values is known to 1 / sqrt(2 * 256), 4 %, of either picture. The means are apart by the noise of the
// first, four deviations at most.
TEST(PathLayers, NoiseBeforeExactColorsFalls) {
    Material glass;
    glass.transmission = 1;
    glass.roughness = 0;
    for (const Material& front : {blended(1, 0.5f), glass}) {
        Scene scene;
        if (!front.transmits()) scene.show(black_wall(), "wall");  // A mirror image of it is no noise.
        app::Session session = session_before_label(front, scene);
        const Image one = render_linear(session, 1);
        for (const int samples : {16, 64}) {
            const Image many = render_linear(session, samples);
            double noise = 0;
            for (int c = 0; c < 3; ++c) {
                const Spread first = spread_of(one, c), mean = spread_of(many, c);
                EXPECT_LE(mean.deviation, 1.2 * first.deviation / std::sqrt(samples) + 1e-6)
                    << front.opacity << ", " << samples << " samples, channel " << c;
                EXPECT_NEAR(mean.mean, first.mean, 4 * first.deviation / spread_side + 1e-3);
                noise += first.deviation;
            }
            EXPECT_GT(noise, 0.01) << front.opacity << ": without noise nothing is tested";
        }
    }
}

}  // namespace
}  // namespace easypbr::path_layers_test
