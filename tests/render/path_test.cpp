// Path tracing against closed forms.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "easypbr/core/stopwatch.h"
#include "render_test.h"

namespace easypbr::path_test {
namespace {

/// Of paths that never end before their light is below what is measured.
app::Session path_session(const Scene& scene, int size = 32) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.path.clamp = 0;
    s.path.bounces = 64;
    s.shadows.enabled = true;
    return session;
}

/// The same under an even sky of radiance 1.
app::Session path_session_under_sky(Scene& scene, int size = 32) {
    scene.set_environment(constant_environment(1));
    app::Session session = path_session(scene, size);
    session.settings().environment.enabled = true;
    return session;
}

Material surface(float color, float metallic, float roughness) {
    Material m;
    m.base_color = Vec3::Constant(color);
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

Mesh ball(const Material& material) {
    Mesh mesh = make_sphere(1, 64);
    mesh.set_material(material);
    return mesh;
}

/// Mean over the pixels that are covered.
Vec3 mean_of(const Image& image) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            sum += Eigen::Map<const Vec4>(image.at<float>(x, y)).cast<double>();
    return (sum.head<3>() / sum.w()).cast<float>();
}

// What reflects all of an even sky shows it. 0.005: roundings of the table of directional albedos, and of the
// roughness to 8 bits; without noise, for all directions that a path may take bring as much.
TEST(Paths, WhiteFurnace) {
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
            Scene scene;
            scene.show(ball(surface(1, metallic, roughness)), "ball");
            app::Session session = path_session_under_sky(scene);
            look_from(session, Vec3d(0, 0, 5), 20);
            EXPECT_NEAR(mean_of(render_linear(session, 64)).x(), 1, 0.005)
                << "metallic " << metallic << ", roughness " << roughness;
        }
}

// The same where the normals are bent by 45 degrees: what they send below the surface is not lost.
TEST(Paths, WhiteFurnaceOfBentNormals) {
    Image normals(2, 2, 3, PixelType::u8);
    for (int i = 0; i < 4; ++i) {
        uint8_t* texel = normals.at<uint8_t>(i % 2, i / 2);
        texel[0] = 217;  // 0.707
        texel[1] = 128;
        texel[2] = 217;
    }
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.2f, 1.0f}) {
            Material m = surface(1, metallic, roughness);
            m.normal_texture.image = std::make_shared<Image>(normals);
            Scene scene;
            scene.show(facing_square(1, m), "square");
            app::Session session = path_session_under_sky(scene);
            look_from(session, Vec3d(0, 1, 4), 20);
            EXPECT_NEAR(mean_of(render_linear(session, 256)).x(), 1, 0.005)
                << "metallic " << metallic << ", roughness " << roughness;
        }
}

// Radiance within a closed sphere that emits 1 and reflects a part p of all: 1 / (1 - p). 0.015: the Fresnel
// reflection at grazing angles adds 0.5 % to the albedo.
TEST(Paths, LightBouncesInASphere) {
    Material m = surface(0.5f, 0, 1);
    m.emissive = Vec3::Ones();
    Scene scene;
    scene.show(ball(m), "ball");
    app::Session session = path_session(scene);
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, Vec3d(0.2, 0.1, 0.3), 60);
    EXPECT_NEAR(mean_of(render_linear(session, 64)).x(), 2, 2 * 0.015);
}

// No light enters a closed room, but for paths that meet an edge to the last bit: less than one in a million.
TEST(Paths, ClosedRoomsAreDark) {
    Mesh room = make_box(Vec3(2, 2, 2));
    room.set_material(surface(0.8f, 0, 1));
    Scene scene;
    scene.show(room, "room");
    app::Session session = path_session_under_sky(scene);
    look_from(session, Vec3d(0.7, 0.5, 0.8), 80);
    EXPECT_LT(mean_of(render_linear(session, 256)).x(), 1e-6);
}

// What a texture says of hidden light is for frames whose rays do not find it.
TEST(Paths, TakeNoNoteOfOcclusionTextures) {
    Image dark(4, 4, 3, PixelType::u8);
    const auto seen = [&](bool has_texture, bool by_paths) {
        Material m = surface(0.5f, 0, 1);
        if (has_texture) m.occlusion_texture.image = std::make_shared<Image>(dark);
        Scene scene;
        scene.show(facing_square(1, m), "square");
        app::Session session = path_session_under_sky(scene, 8);
        session.settings().path.enabled = by_paths;
        look_from(session, Vec3d(0, 0, 4), 20);
        return mean_of(render_linear(session, 4)).x();
    };
    EXPECT_LT(seen(true, false), 0.5 * seen(false, false));
    EXPECT_EQ(seen(true, true), seen(false, true));
    EXPECT_GT(seen(true, true), 0.3);
}

// Lambert: albedo I cos / (pi d^2), of one light without noise.
TEST(Paths, PointLight) {
    Scene scene;
    scene.show(facing_square(1, surface(0.5f, 0, 1)), "square");
    Light light;
    light.position = Vec3d(0, 0, 2);
    light.intensity = 7;
    light.radius = 0;
    scene.set_light("point", light);
    app::Session session = path_session(scene, 65);
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, Vec3d(0, 0, 5), 20);
    const Image image = render_linear(session, 4);
    EXPECT_NEAR(image.at<float>(32, 32)[0] / (0.5 * 7 / (4 * pi)), 1, 0.005);
}

// Of many lights one is chosen for each path, as likely as it is bright: their sum has no noise where all of
// them arrive. More than one block of them.
TEST(Paths, ManyLights) {
    Scene scene;
    scene.show(facing_square(1, surface(0.5f, 0, 1)), "square");
    double expected = 0;
    for (int i = 0; i < 100; ++i) {
        Light light;
        light.type = LightType::directional;
        light.direction = Vec3(0.01f * float(i - 50), 0, -1);
        light.intensity = 0.01f * float(i + 1);
        light.angular_radius_deg = 0;
        scene.set_light("light " + std::to_string(i), light);
        expected += 0.5 / pi * light.intensity / light.direction.norm();
    }
    app::Session session = path_session(scene, 65);
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, Vec3d(0, 0, 5), 20);
    EXPECT_NEAR(render_linear(session, 4).at<float>(32, 32)[0] / expected, 1, 0.01);
}

/// A floor of albedo 0.5 at z = 0 under a square lamp at z = 1 that faces it and reflects nothing.
Scene floor_under_lamp(float half, const Material& lamp) {
    Scene scene;
    scene.show(facing_square(0.5f, surface(0.5f, 0, 1)), "floor");
    Mesh square = facing_square(half, lamp);
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.translation() = Vec3d(0, 0, 1);
    square.set_T_world_mesh(pose);
    scene.show(square, "lamp");
    return scene;
}

Material emissive(float radiance) {
    Material m = surface(0, 0, 1);
    m.emissive = Vec3::Constant(radiance);
    return m;
}

/// What the floor shows below the middle of the lamp: one pixel, at most 0.08 wide, past the lamp's side.
double seen_below(app::Session& session, int samples, const Vec3d& eye = Vec3d(4, 0, 1.5)) {
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, eye, 1.2f);
    return render_linear(session, samples).at<float>(1, 1)[0];
}

/// Part of a floor's hemisphere, weighted by the cosine, that one quarter of a parallel square of half width
/// a covers, seen from below its middle at distance 1 (Howell, A Catalog of Radiation Heat Transfer
/// Configuration Factors, B-4).
double quarter_factor(double a) {
    const double root = std::sqrt(1 + a * a);
    return a / root * std::atan(a / root) / pi;
}

// Lambert: albedo times radiance times the part of the hemisphere. 0.005: lamps that small look alike from
// every point of theirs and the pixel's; by chance one path in 300 meets it, 14 +- 4 of 4096, which count
// about twice: 0.002.
TEST(Paths, SmallEmissiveSquare) {
    Scene scene = floor_under_lamp(0.05f, emissive(40));
    app::Session session = path_session(scene, 3);
    EXPECT_NEAR(seen_below(session, 4096, {1.5, 0, 3}) / (0.5 * 40 * 4 * quarter_factor(0.05)), 1, 0.005);
}

// Of a large lamp one half shines. 0.015: the standard error of 4096 independent samples is
// 0.019; Sobol's points are more even.
TEST(Paths, TexturedEmissiveSquare) {
    Image halves(64, 1, 3, PixelType::u8);
    for (int x = 0; x < 64; ++x)
        for (int c = 0; c < 3; ++c) halves.at<uint8_t>(x, 0)[c] = x < 32 ? 255 : 0;
    Material lamp = emissive(3);
    lamp.emissive_texture.image = std::make_shared<Image>(halves);
    Scene scene = floor_under_lamp(1, lamp);
    app::Session session = path_session(scene, 3);
    EXPECT_NEAR(seen_below(session, 4096) / (0.5 * 3 * 2 * quarter_factor(1)), 1, 0.015);
}

// Each image of an unchanged scene has its objects at other addresses.
TEST(Paths, EmissiveMeshesStayBetweenImages) {
    Scene scene = floor_under_lamp(0.3f, emissive(5));
    app::Session session = path_session(scene, 3);
    const double first = seen_below(session, 64);
    std::vector<SceneSnapshot> held;  // so that the next image's objects are elsewhere in memory
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 20; ++k) held.push_back(scene.snapshot());
        EXPECT_EQ(seen_below(session, 64), first);
    }
    EXPECT_GT(first, 0.01);
}

// Light adds up, whichever of both a path looks for. 0.015: as above.
TEST(Paths, EmissiveSquareUnderASky) {
    Image map(16, 8, 3, PixelType::f32);
    for (float& v : map.pixels<float>()) v = 0.2f;
    for (int c = 0; c < 3; ++c) map.at<float>(3, 3)[c] = 60;
    const auto seen = [&](float emission, bool sky) {
        Scene scene = floor_under_lamp(0.3f, emissive(emission));
        if (sky) scene.set_environment(Environment(map));
        app::Session session = path_session(scene, 3);
        session.settings().environment.enabled = sky;
        return seen_below(session, 4096);
    };
    const double of_lamp = seen(5, false), of_sky = seen(0, true), of_both = seen(5, true);
    EXPECT_GT(of_lamp, 0.1 * of_both);
    EXPECT_GT(of_sky, 0.1 * of_both);
    EXPECT_NEAR(of_both / (of_lamp + of_sky), 1, 0.015);
}

// A cube that emits, above a small matt square: of its faces the lower one alone is seen, whose light by the
// form factor of parallel squares' centres is known. With four samples the deviation is below 0.2: what falls
// on the place varies by 0.1 over that face. Were all faces chosen alike, a third of the pixels would have no
// sample on it, and the deviation would be above 0.4.
TEST(Paths, HiddenFacesGetNoSamples) {
    constexpr double half = 0.5, height = 2;
    Mesh cube = make_box(Vec3::Constant(2 * half));
    Material material = surface(0, 0, 1);
    material.emissive = Vec3::Ones();
    cube.set_material(material);
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.translation() = Vec3d(0, 0, height + half);
    cube.set_T_world_mesh(pose);
    Scene scene;
    scene.show(cube, "cube");
    scene.show(facing_square(0.1f, surface(1, 0, 1)), "square");
    app::Session session = path_session(scene, 16);
    session.settings().shading.dielectric_f0 = 0;
    session.settings().path.bounces = 1;
    look_from(session, Vec3d(1, 0, 1), 1);
    const double side = half / std::hypot(half, height);
    const double form_factor = 4 / (2 * pi) * 2 * side * std::atan(side);
    const Image image = render_linear(session, 4);
    double squares = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) squares += std::pow(image.at<float>(x, y)[0] / form_factor - 1, 2);
    EXPECT_LT(std::sqrt(squares / 256), 0.2);
}

// A half of an even sky lies below a wall's horizon: on a floor beside a wall without end the other half
// arrives. A wall of albedo 0. 0.02: 1024 samples of one pixel are even within 0.015.
TEST(Paths, SkyBesideAWall) {
    Scene scene;
    Mesh floor = facing_square(1, surface(1, 0, 1));
    Mesh wall = facing_square(40, surface(0, 0, 1));
    scene.show(floor, "floor");
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.linear() = Eigen::AngleAxisd(pi / 2, Vec3d::UnitY()).toRotationMatrix();
    pose.translation() = Vec3d(-0.05, 0, 40);
    wall.set_T_world_mesh(pose);
    scene.show(wall, "wall");
    app::Session session = path_session_under_sky(scene, 3);
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, Vec3d(0, 0, 5), 0.02f * 57);
    EXPECT_NEAR(render_linear(session, 1024).at<float>(1, 1)[0], 0.5, 0.02);
}

// Twice the same, byte for byte.
TEST(Paths, AreDeterministic) {
    Scene scene;
    scene.show(ball(surface(0.7f, 0.5f, 0.4f)), "ball");
    app::Session session = path_session(scene);
    session.settings().environment.enabled = true;
    session.settings().ground.mode = GroundMode::plane;
    look_from(session, Vec3d(3, 2, 5), 30);
    const Image first = render_linear(session, 4), second = render_linear(session, 4);
    EXPECT_TRUE(std::ranges::equal(first.pixels<float>(), second.pixels<float>()));
}

// The error falls with the square root of the number of samples: by 4 for 16 times as many, or more, as
// the samples of a pixel are evenly spread.
TEST(Paths, ErrorsFallWithSamples) {
    Scene scene;
    scene.show(ball(surface(0.7f, 0, 0.4f)), "ball");
    app::Session session = path_session(scene);
    session.settings().environment.enabled = true;  // the studio
    session.settings().ground.mode = GroundMode::plane;
    look_from(session, Vec3d(3, 2, 5), 30);
    const Image reference = render_linear(session, 4096);
    const auto error_of = [&](int samples) {
        const Image image = render_linear(session, samples);
        double sum = 0;
        for (size_t i = 0; i < image.pixels<float>().size(); ++i)
            sum += std::pow(double(image.pixels<float>()[i]) - reference.pixels<float>()[i], 2);
        return std::sqrt(sum);
    };
    EXPECT_GT(error_of(4) / error_of(64), 3.5);
}

// Mean distance of a picture to another, of 255.
double apart(const Image& a, const Image& b) {
    double sum = 0;
    const auto x = a.bytes(), y = b.bytes();
    for (size_t i = 0; i < x.size(); ++i) sum += std::abs(int(x[i]) - int(y[i]));
    return sum / double(x.size());
}

/// A ball on a ground: what many samples show, few, and the same few denoised.
struct DenoisedBall {
    Image reference, noisy, denoised;

    explicit DenoisedBall(GroundMode ground, int samples = 8) {
        Scene scene;
        scene.show(ball(surface(0.5f, 0, 0.5f)), "ball");
        app::Session session = path_session_under_sky(scene, 64);
        session.settings().ground.mode = ground;
        const auto drawn = [&](Denoising denoise, int samples) {
            session.settings().path.denoise = denoise;
            return session.render({std::nullopt, samples});
        };
        reference = drawn(Denoising::off, 512);
        noisy = drawn(Denoising::off, samples);
        denoised = drawn(Denoising::filter, samples);
    }
};

// Half of the noisy picture's error at most: in a picture this small the silhouette, which keeps its noise,
// is a large part.
TEST(Paths, DenoisedPicturesAreCloser) {
    const auto [reference, noisy, denoised] = DenoisedBall(GroundMode::plane);
    EXPECT_LT(apart(denoised, reference), apart(noisy, reference) / 2);
}

// The same of a single frame, whose noise is not known from others.
TEST(Paths, DenoisedSingleFramesAreCloser) {
    const auto [reference, noisy, denoised] = DenoisedBall(GroundMode::plane, 1);
    EXPECT_LT(apart(denoised, reference), apart(noisy, reference) / 2);
}

// The same of a shadow catcher's alpha.
TEST(Paths, DenoisedShadowsAreCloser) {
    const DenoisedBall ball(GroundMode::shadow);
    const Image& reference = ball.reference;
    const auto alpha_apart = [&](const Image& image) {
        double sum = 0;
        for (int y = 48; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                sum += std::abs(int(image.at<uint8_t>(x, y)[3]) - int(reference.at<uint8_t>(x, y)[3]));
        return sum / (16 * 64);
    };
    EXPECT_GT(alpha_apart(ball.noisy), 2);
    EXPECT_LT(alpha_apart(ball.denoised), alpha_apart(ball.noisy) / 2);
}

// Light without noise is kept: 0.02 of 255 are roundings.
TEST(Paths, DenoisingLeavesWhatHasConverged) {
    Scene scene;
    scene.show(facing_square(1, surface(0.5f, 0, 1)), "square");
    Light light;
    light.position = Vec3d(0, 0, 2);
    light.radius = 0;
    scene.set_light("light", light);
    app::Session session = path_session(scene, 64);
    session.settings().path.denoise = Denoising::off;
    const Image exact = session.render({std::nullopt, 64});
    session.settings().path.denoise = Denoising::filter;
    EXPECT_LT(apart(session.render({std::nullopt, 64}), exact), 0.02);
}

// Scene-linear pictures are references: nothing is taken out of them unless it is asked for.
TEST(Paths, LinearPicturesAreNotDenoised) {
    Scene scene;
    scene.show(ball(surface(0.5f, 0, 0.5f)), "ball");
    app::Session session = path_session_under_sky(scene, 32);
    const auto drawn = [&](Denoising denoise) {
        session.settings().path.denoise = denoise;
        return session.render({std::nullopt, 4, Encoding::scene_linear});
    };
    const Image automatic = drawn(Denoising::best), off = drawn(Denoising::off),
                filter = drawn(Denoising::filter);
    EXPECT_TRUE(std::ranges::equal(automatic.bytes(), off.bytes()));
    EXPECT_FALSE(std::ranges::equal(filter.bytes(), off.bytes()));
}

// The picture that refinement ends with, and its number of frames.
std::pair<Image, int> refined(app::Session& session, int samples) {
    for (;;) {
        const auto done = session.refine({std::nullopt, samples});
        if (done.frames == done.total) return {done.drawn.picture(), done.frames};
    }
}

// Mean distances of squares of 16 x 16 pixels of a grey surface that covers both pictures, from 0 to 1,
// sorted.
std::vector<double> tiles_apart(const Image& a, const Image& b) {
    std::vector<double> distances;
    for (int y0 = 0; y0 < a.height(); y0 += 16)
        for (int x0 = 0; x0 < a.width(); x0 += 16) {
            double sum = 0;
            for (int i = 0; i < 256; ++i) {
                const int x = x0 + i % 16, y = y0 + i / 16;
                sum += std::abs(int(a.at<uint8_t>(x, y)[1]) - int(b.at<uint8_t>(x, y)[1]));
            }
            distances.push_back(sum / 256 / 255);
        }
    std::ranges::sort(distances);
    return distances;
}

// The noise that is asked for is the noise that there is. A normal deviate's mean distance is 0.8 deviations.
// 30 %: green for luminance, the reference's own noise, a power for sRGB's curve, and tiles that differ
// within. Down to half: noise is estimated as that of independent samples, and Sobol's points are more even.
TEST(Paths, EndOnceNoiseIsLow) {
    Scene scene;
    scene.show(ball(surface(0.5f, 0, 1)), "ball");
    app::Session session = path_session_under_sky(scene, 128);
    session.settings().path.denoise = Denoising::off;
    look_from(session, Vec3d(0, 0, 3), 20);
    Light light;
    light.position = Vec3d(3, 3, 3);
    light.radius = 2;
    light.intensity = 60;
    scene.set_light("lamp", light);
    const auto [reference, all] = refined(session, 400);
    EXPECT_EQ(all, 400);
    constexpr float asked = 0.008f;
    session.settings().image.noise = asked;
    const auto [picture, frames] = refined(session, 400);
    EXPECT_GT(frames, 4);
    EXPECT_LT(frames, 100);
    const std::vector<double> distances = tiles_apart(picture, reference);
    const double noise = distances[size_t(double(distances.size()) * 0.95)] / 0.8;
    EXPECT_LT(noise, 1.3 * asked);
    EXPECT_GT(noise, 0.5 * asked);
    EXPECT_TRUE(std::ranges::equal(session.render({std::nullopt, 400}).bytes(), picture.bytes()));
}

TEST(Session, PicturesEndWithTheirTime) {
    Scene scene;
    scene.show(ball(surface(0.5f, 0, 0.5f)), "ball");
    app::Session session = plain_session(scene);
    session.settings().image.time_budget = 0.2f;
    const Timer timer;
    const auto [picture, frames] = refined(session, 65536);
    EXPECT_LT(frames, 65536);
    EXPECT_LT(timer.seconds(), 10);
    session.settings().image.time_budget = 1e-6f;
    EXPECT_EQ(refined(session, 16).second, 1);
}

}  // namespace
}  // namespace easypbr::path_test
