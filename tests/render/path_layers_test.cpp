// Blended surfaces that are lit by paths.
#include <cmath>
#include <cstdlib>

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

// On a floor beside a black wall without end a half of the sky arrives, and the floor shows a half of that: a
// quarter, and covers a half. 0.01: 1024 samples of one pixel. The raster frame does not know of the wall.
TEST(PathLayers, SkyBesideAWall) {
    for (const bool native : {true, false}) {
        Scene scene;
        scene.show(facing_square(1, blended(1, 0.5f)), "floor");
        Mesh wall = facing_square(40, blended(0, 1));
        Eigen::Affine3d pose = Eigen::Affine3d::Identity();
        pose.linear() = Eigen::AngleAxisd(pi / 2, Vec3d::UnitY()).toRotationMatrix();
        pose.translation() = Vec3d(-0.05, 0, 40);
        wall.set_T_world_mesh(pose);
        scene.show(wall, "wall");
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
// opaque ball. 0.005: roundings of the table of directional albedos.
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
        EXPECT_NEAR(mean_of_middle(render_linear(session, 64)), 1, 0.005) << clearcoat;
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

/// Mean distance of the channels, of 255.
double apart(const Image& a, const Image& b) {
    double sum = 0;
    for (size_t i = 0; i < a.bytes().size(); ++i) sum += std::abs(int(a.bytes()[i]) - int(b.bytes()[i]));
    return sum / double(a.bytes().size());
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

}  // namespace
}  // namespace easypbr::path_layers_test
