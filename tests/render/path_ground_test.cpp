// What path traced surfaces get of the sky below a ground, against closed forms.
#include <cmath>

#include "render_test.h"

namespace easypbr::path_ground_test {
namespace {

constexpr int size = 16;
constexpr double height = 20;  ///< of the wall above the ground, of which it hides less than 0.001 of the sky

/// Black above, and of this radiance in the cone of half this angle around the direction down.
Environment light_from_below(float radiance, double cone) {
    // Of fewer texels light is filtered between them, and there is some above the edge.
    constexpr int rows = 128;
    Image image(2 * rows, rows, 3, PixelType::f32);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 2 * rows; ++x)
            std::fill_n(image.at<float>(x, y), 3, pi * (y + 0.5) / rows > pi - cone ? radiance : 0.0f);
    return Environment(image);
}

/// On a vertical wall that reflects everything evenly: the light's cosine, divided by pi, over the cone.
double light_on_wall(double radiance, double cone) {
    return radiance / pi * (cone - std::sin(cone) * std::cos(cone));
}

Material surface(float metallic, float roughness) {
    Material m;
    m.base_color = Vec3::Ones();
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

/// Of paths over a ground that reflects nothing.
app::Session session_of_paths(const Scene& scene, GroundMode mode, double ground_height) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.path.clamp = 0;
    s.path.denoise = Denoising::off;
    s.environment.enabled = true;
    s.shading.dielectric_f0 = 0;
    s.ground.mode = mode;
    s.ground.height = ground_height;
    s.ground.plane_color = Vec3::Zero();
    return session;
}

app::Session session_of_wall(const Material& material, const Environment& sky, GroundMode mode) {
    Scene scene;
    scene.show(facing_square(1, material), "wall");
    scene.set_environment(sky);
    app::Session session = session_of_paths(scene, mode, -height);
    Settings& s = session.settings();
    s.shadows.enabled = true;
    s.ground.radius = 1e6f;  // a plane is open by 1e-4 of a right angle above its edge
    look_from(session, Vec3d(0, 0, 5), 10);
    return session;
}

double mean_of(app::Session& session, int samples) {
    const Image image = render_linear(session, samples);
    double sum = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) sum += double(image.at<float>(x, y)[0]);
    return sum / (size * size);
}

// A black plane hides all that is below the horizon. 1e-3: what comes past its edge.
TEST(PathGround, APlaneHidesTheSkyBelow) {
    for (const float metallic : {0.0f, 1.0f}) {
        const Material material = surface(metallic, metallic > 0 ? 0.6f : 1.0f);
        app::Session session = session_of_wall(material, light_from_below(1, pi / 2), GroundMode::plane);
        EXPECT_NEAR(mean_of(session, 16), 0, 1e-3) << metallic;
    }
}

// A plane hides what shines below it. Else a plate of 4 x 2 before the wall, 4 below it, sends 0.035.
TEST(PathGround, APlaneHidesEmittersBelow) {
    for (const bool hidden : {false, true}) {
        app::Session session = session_of_wall(surface(0, 1), constant_environment(0), GroundMode::plane);
        Material lamp;
        lamp.base_color = Vec3::Zero();
        lamp.emissive = Vec3::Ones();
        Mesh plate = make_box(Vec3(4, 0.1f, 4));
        plate.set_material(lamp);
        plate.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, -4, 0)));
        session.scene().show(plate, "lamp");
        session.settings().environment.enabled = false;
        session.settings().ground.height = hidden ? -2.0 : -6.0;
        if (hidden)
            EXPECT_EQ(mean_of(session, 4), 0);
        else
            EXPECT_GT(mean_of(session, 4), 0.02);
    }
}

// A catcher shows the sky below to matt surfaces, once, before all backgrounds. Of the half below the horizon
// half arrives at a wall. 0.015: three deviations of 256 samples in 256 pixels that the cosine distributes,
// of which 0.0125 find a cone of the radiance 10.
TEST(PathGround, ACatcherShowsTheSkyBelowOnce) {
    EXPECT_NEAR(light_on_wall(1, pi / 2), 0.5, 1e-12);
    for (const double cone : {pi / 2, pi / 8})
        for (const BackgroundMode background : {BackgroundMode::transparent, BackgroundMode::color}) {
            const float radiance = cone < 1 ? 10 : 1;
            app::Session session =
                session_of_wall(surface(0, 1), light_from_below(radiance, cone), GroundMode::shadow);
            session.settings().background.mode = background;
            session.settings().background.color = Vec3::Zero();
            EXPECT_NEAR(mean_of(session, 256), light_on_wall(double(radiance), cone), 0.015)
                << cone << ", " << int(background);
        }
}

// Specular lobes find it likewise: the same as without a ground, but for 0.001 and twice the noise of a
// metal's lobe, which is narrower than the cosine.
TEST(PathGround, MetalsSeeTheSkyBelowACatcherOnce) {
    const auto seen = [](GroundMode mode) {
        app::Session session = session_of_wall(surface(1, 0.6f), light_from_below(1, pi / 2), mode);
        return mean_of(session, 64);
    };
    const double open = seen(GroundMode::none);
    EXPECT_GT(open, 0.3);
    EXPECT_NEAR(seen(GroundMode::shadow), open, 0.015);
}

// White disappears in an even sky with a bright spot below, whose directions are chosen: the spot adds its
// light alone. 0.015: as above.
TEST(PathGround, WhiteIsWhiteAboveACatcher) {
    Image image(128, 64, 3, PixelType::f32);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) std::fill_n(image.at<float>(x, y), 3, y < 56 ? 1.0f : 11.0f);
    for (const GroundMode mode : {GroundMode::none, GroundMode::shadow}) {
        app::Session session = session_of_wall(surface(0, 1), Environment(image), mode);
        EXPECT_NEAR(mean_of(session, 256), 1 + light_on_wall(10, pi / 8), 0.015) << int(mode);
    }
}

// A mirror turns the view (0, 0, -1) at (0, -sin 15, cos 15) of a ball to (0, -0.5, cos 30), which meets a
// ground 1.5 below 3.1157 from the foot. Where that is 0.7 of the radius, half of a plane is left: there it
// hides half of an even sky. 0.02: 65536 rays that pass it or not have a deviation of 0.002, and the picture
// shows places from 0.66 to 0.74.
TEST(PathGround, APlaneFades) {
    Scene scene;
    Mesh ball = make_sphere(1, 256);
    ball.set_material(surface(1, 0));
    scene.show(ball, "ball");
    scene.set_environment(constant_environment(1));
    app::Session session = session_of_paths(scene, GroundMode::plane, -1.5);
    Settings& s = session.settings();
    s.ground.radius = 3.1157f / 0.7f;
    s.camera.position = Vec3d(0, -0.25882, 4.6);
    s.camera.target = Vec3d(0, -0.25882, 0);
    s.camera.fov_y_deg = 1;
    EXPECT_NEAR(mean_of(session, 256), 0.5, 0.02);
}

// Close above a ground that is seen from below, a surface is as it is without one: white in an even sky,
// traced in both ways. 0.02: colours of 16 bits and lights of half precision.
TEST(PathGround, FromBelowThereIsNone) {
    for (const GroundMode mode : {GroundMode::shadow, GroundMode::plane})
        for (const Projection projection : {Projection::perspective, Projection::orthographic})
            for (const bool paths : {true, false}) {
                Scene scene;
                Mesh square = facing_square(1, surface(0, 1));
                square.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())));
                scene.show(square, "bottom");
                scene.set_environment(constant_environment(1));
                app::Session session = plain_session(scene, size);
                Settings& s = session.settings();
                s.path.enabled = paths;
                s.path.denoise = Denoising::off;
                s.rays.enabled = !paths;
                s.ssao.enabled = !paths;
                s.shadows.enabled = true;
                s.environment.enabled = true;
                s.shading.dielectric_f0 = 0;
                s.ground.mode = mode;
                s.ground.height = -0.01;
                s.ground.plane_color = Vec3::Zero();
                s.camera.projection = projection;
                s.camera.ortho_height = 0.5;
                look_from(session, Vec3d(0, -5, 1), 5);
                EXPECT_NEAR(mean_of(session, 16), 1, 0.02)
                    << int(mode) << ", " << int(projection) << ", " << paths;
            }
}

/// What the ball of APlaneFades mirrors of a ground 1.5 below that catches shadows: the place 3.1157 from the
/// foot. The sun comes from behind the ball, which throws its shadow there, or from before it.
double caught_in_mirror(bool rays, BackgroundMode background, bool behind) {
    Scene scene;
    Mesh ball = make_sphere(1, 256);
    ball.set_material(surface(1, 0));
    scene.show(ball, "ball");
    scene.set_environment(constant_environment(0.5f));
    Light sun;
    sun.type = LightType::directional;
    sun.direction = Vec3(0, -1.5f, behind ? 3.1157f : -3.1157f);
    sun.angular_radius_deg = 0;
    sun.intensity = 1000;
    scene.set_light("sun", sun);
    app::Session session = session_of_paths(scene, GroundMode::shadow, -1.5);
    Settings& s = session.settings();
    s.path.enabled = !rays;
    s.rays.enabled = rays;
    s.shadows.enabled = true;
    s.background.mode = background;
    s.background.color = Vec3::Ones();
    s.camera.position = Vec3d(0, -0.25882, 4.6);
    s.camera.target = Vec3d(0, -0.25882, 0);
    s.camera.fov_y_deg = 1;
    return mean_of(session, 16);
}

// Mirrors show the shadows of lamps on such a ground before all backgrounds, in place of what lies behind it:
// the sun sends a thousand times the sky's light, so that hardly anything is left of its shadow, and all
// where it shines. 0.01: of 1000 sin(25.7) / pi + 0.5 that arrives the sky has 0.004.
TEST(PathGround, MirrorsShowTheShadowsOfLampsOnACatcher) {
    for (const bool rays : {false, true})
        for (const BackgroundMode background :
             {BackgroundMode::transparent, BackgroundMode::environment, BackgroundMode::color}) {
            SCOPED_TRACE(testing::Message() << rays << ", " << int(background));
            const double open = caught_in_mirror(rays, background, false);
            EXPECT_GT(open, 0.45);
            EXPECT_LT(caught_in_mirror(rays, background, true), 0.01 * open);
        }
}

/// The mirrored ground of a mirror under a black roof, which leaves a strip of the sky above the horizon.
/// The sky is 20 within 15 degrees from the zenith and 0.5 elsewhere.
double covered_in_mirror(bool rays) {
    constexpr int rows = 64;
    Image sky(2 * rows, rows, 3, PixelType::f32);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < 2 * rows; ++x)
            std::fill_n(sky.at<float>(x, y), 3, 180 * (y + 0.5) / rows < 15 ? 20.0f : 0.5f);
    Scene scene;
    Mesh mirror = facing_square(1.4f, surface(1, 0)), roof = facing_square(6, surface(0, 1));
    Material black = surface(0, 1);
    black.base_color = Vec3::Zero();
    roof.set_material(black);
    roof.set_T_parent_mesh(Eigen::Translation3d(0, 1.5, 0) * Eigen::AngleAxisd(pi / 2, Vec3d::UnitX()));
    scene.show(mirror, "mirror");
    scene.show(roof, "roof");
    scene.set_environment(Environment(sky));
    app::Session session = session_of_paths(scene, GroundMode::shadow, 0);
    Settings& s = session.settings();
    s.path.enabled = !rays;
    s.rays.enabled = rays;
    s.background.mode = BackgroundMode::environment;
    s.camera.position = Vec3d(0, 0.7, 2.5);
    s.camera.target = Vec3d(0, 0.1, 0);
    s.camera.fov_y_deg = 2;
    return mean_of(session, 64);
}

// The edges of the roof are 5.5 and more away from the place and 1.5 above it: at most the sky below 15.3
// degrees is open. Of the light that would arrive, 0.5 + 19.5 sin(15)^2 = 1.81, less than 0.5 sin(15.3)^2 =
// 0.035 is left, 1.9 % of the 0.5 that are mirrored: 0.0096.
TEST(PathGround, MirrorsShowHowLittleOfABrightSkyIsLeft) {
    for (const bool rays : {false, true}) {
        const double seen = covered_in_mirror(rays);
        EXPECT_GT(seen, 0.001) << rays;
        EXPECT_LT(seen, 0.0096) << rays;
    }
}

}  // namespace
}  // namespace easypbr::path_ground_test
