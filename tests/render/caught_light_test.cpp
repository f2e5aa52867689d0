// What path traced pictures show of a ground that catches shadows, against closed forms.
#include <cmath>

#include "render_test.h"

namespace easypbr::caught_light_test {
namespace {

constexpr double height = 1.5;  ///< of what casts the shadow, above the ground
constexpr int size = 17;        ///< of images, whose pixels all show nearly the same place

/// A view of the ground's place at (x, -height, 0), under a sky alone.
app::Session session_at(const Scene& scene, double x) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.shadows.enabled = true;
    s.environment.enabled = true;
    s.ground.mode = GroundMode::shadow;
    s.ground.height = -height;
    s.camera.position = Vec3d(x + 2, 2 - height, 0);
    s.camera.target = Vec3d(x, -height, 0);
    s.camera.fov_y_deg = 1;
    return session;
}

double alpha_of(app::Session& session, int samples) {
    const Image image = render_linear(session, samples);
    double alpha = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) alpha += image.at<float>(x, y)[3];
    return alpha / (size * size);
}

/// A ball of radius 1 around the origin; around the box that holds it there is a larger ball, of sqrt(3).
Scene ball_scene(const Environment& sky) {
    Scene scene;
    scene.show(make_sphere(1, 128), "ball");
    scene.set_environment(sky);
    return scene;
}

/// The part of an even sky's irradiance that a ball of radius 1 hides, all of which is above the horizon.
double form_factor(double x) {
    const double distance = std::hypot(x, height);
    return height / (distance * distance * distance);
}

// Under the middle of a disc of radius r at height h the part h^2 / (h^2 + r^2) of an even sky arrives. 0.01:
// the noise of 64 samples of each pixel.
TEST(CaughtLight, OfADisc) {
    Scene scene;
    scene.show(make_cylinder(float(height), 0.001f, 128), "disc");
    scene.set_environment(constant_environment(1));
    app::Session session = session_at(scene, 0);
    session.settings().camera.position = Vec3d(2.2, 0.5 - height, 0);  // below the disc
    EXPECT_NEAR(alpha_of(session, 64), 0.5, 0.01);
}

/// The form factor of a square of this half side, facing the place below its middle, at a distance of 1.
double form_factor_of_square(double half) {
    const double root = std::sqrt(1 + half * half);
    return 4 / pi * half / root * std::atan(half / root);
}

// A square lamp of 4 x 4 at a distance of 2, of which a square of 1 x 1 at a distance of 1 hides the middle
// quarter, 2 x 2, with and without a sky (of no light to speak of). 0.01: the noise of 64 samples.
TEST(CaughtLight, OfASquareLamp) {
    for (const bool has_sky : {false, true}) {
        Scene scene;
        Mesh square = facing_square(0.5f);
        square.set_T_parent_mesh(Eigen::Translation3d(0, 1 - height, 0) *
                                 Eigen::Affine3d(Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())));
        scene.show(square, "square");
        Light lamp;
        lamp.type = LightType::rectangle;
        lamp.position = Vec3d(0, 2 - height, 0);
        lamp.direction = Vec3(0, -1, 0);
        lamp.size = Vec2(4, 4);
        scene.set_light("lamp", lamp);
        scene.set_environment(constant_environment(1e-4f));
        app::Session session = session_at(scene, 0);
        session.settings().environment.enabled = has_sky;
        session.settings().camera.position = Vec3d(1.2, 0.9 - height, 0);  // below the lamp
        EXPECT_NEAR(alpha_of(session, 64), form_factor_of_square(0.5) / form_factor_of_square(1), 0.01)
            << has_sky;
    }
}

// Of a place in the ball around the box, just outside of it, and far away, where a third of the directions
// that are tried meets the ball, and one in four frames tries. 3 deviations of independent samples.
TEST(CaughtLight, OfABallNearAndFar) {
    const Scene scene = ball_scene(constant_environment(1));
    for (const double x : {0.5, 1.0, 1.6, 4.0, 12.0}) {
        app::Session session = session_at(scene, x);
        const int samples = 128;
        const double tried = size * size * samples / 4.0;
        EXPECT_NEAR(alpha_of(session, samples) / form_factor(x), 1, 3 * std::sqrt(2 / tried)) << x;
    }
}

/// An even sky of radiance 1 with a patch of another one around a direction.
struct PatchedSky {
    PatchedSky(const Vec3d& middle, float radiance) {
        Image image(256, 128, 3, PixelType::f32);
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 256; ++x) {
                const double theta = pi * (y + 0.5) / 128, phi = 2 * pi * ((x + 0.5) / 256 - 0.5);
                const Vec3d direction(std::sin(theta) * std::sin(phi), std::cos(theta),
                                      -std::sin(theta) * std::cos(phi));
                const bool inside = direction.dot(middle.normalized()) > std::cos(radians(4.0));
                for (int c = 0; c < 3; ++c) image.at<float>(x, y)[c] = inside ? radiance : 1;
                if (inside) {
                    const double solid_angle =
                        2 * pi / 256 * (std::cos(pi * y / 128) - std::cos(pi * (y + 1) / 128));
                    added += (radiance - 1) * solid_angle * direction.y() / pi;
                }
            }
        environment = Environment(image);
    }

    Environment environment;
    double added = 0;  ///< to the irradiance on the ground over pi
};

// Bright light from behind the ball is gone, and a part of what comes from elsewhere. 0.005: the noise of
// 1024 samples.
TEST(CaughtLight, OfABrightSpotBehindABall) {
    for (const double x : {1.0, 4.0}) {
        const PatchedSky sky(Vec3d(-x, height, 0), 300);
        const Scene scene = ball_scene(sky.environment);
        app::Session session = session_at(scene, x);
        const double expected = (form_factor(x) + sky.added) / (1 + sky.added);
        EXPECT_GT(sky.added, 0.2);
        EXPECT_NEAR(alpha_of(session, 256), expected, 0.005) << x;
    }
}

// Bright light from the other side makes the same shadow weaker. 2 % of the value: the noise of 256 samples.
TEST(CaughtLight, OfABrightSpotBesideABall) {
    for (const double x : {1.0, 4.0}) {
        const PatchedSky sky(Vec3d(x, height, 0), 300);
        const Scene scene = ball_scene(sky.environment);
        app::Session session = session_at(scene, x);
        const double expected = form_factor(x) / (1 + sky.added);
        EXPECT_NEAR(alpha_of(session, 256) / expected, 1, 0.02) << x;
    }
}

}  // namespace
}  // namespace easypbr::caught_light_test
