// What the raster frame shows of the ground in surfaces that mirror it, on both devices.
#include "easypbr/core/color.h"
#include "shadow_test.h"

namespace easypbr::mirrored_ground_test {
namespace {

constexpr int size = 16;
constexpr double height = 1.5;
const Vec3 page(0.8f, 0.5f, 0.3f);

Material metal(float roughness) {
    Material m;
    m.base_color = Vec3::Ones();
    m.roughness = roughness;
    m.metallic = 1;
    return m;
}

/// A ball of radius 1 above a ground; the picture shows the place (0, -0.6, 0.8) of it, from ahead: a mirror
/// turns the view there to (0, -0.96, 0.28), which meets the ground at (0, -1.5, 1.0625).
Scene scene_of_ball(const Material& material) {
    Scene scene;
    Mesh ball = make_sphere(1, 256);
    ball.set_material(material);
    scene.show(ball, "ball");
    return scene;
}

app::Session session_on_ground(const Scene& scene, GroundMode mode) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.shadows.enabled = true;
    s.shadows.mode = ShadowMode::hard;
    s.background.mode = BackgroundMode::color;
    s.background.color = page;
    s.ground.mode = mode;
    s.ground.height = -height;
    s.camera.position = Vec3d(0, -0.6, 4.6);
    s.camera.target = Vec3d(0, -0.6, 0);
    s.camera.fov_y_deg = 1;
    return session;
}

Vec3 mean_of(app::Session& session, int samples = 1) {
    const Image image = render_linear(session, samples);
    Vec3 sum = Vec3::Zero();
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) sum += Vec3(image.at<float>(x, y));
    return sum / float(size * size);
}

void expect_near(const Vec3& seen, const Vec3& expected, double tolerance, const char* what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], tolerance) << what << ", " << c;
}

// Before a background of one colour, in a sky that differs from it and without one. 0.005: the mean of a
// mirror's directional albedo at a roughness of 0 is 0.999, and halves have 11 bits.
TEST(MirroredGround, IsTheBackgroundUnderACatcher) {
    for (const bool sky : {true, false})
        for (const bool native : {true, false}) {
            Scene scene = scene_of_ball(metal(0));
            if (sky) scene.set_environment(constant_environment(3));
            app::Session session = session_on_ground(scene, GroundMode::shadow);
            session.settings().environment.enabled = sky;
            session.allow_native_geometry(native);
            expect_near(mean_of(session), linear_from_srgb(page), 0.005, native ? "native" : "driver");
        }
}

// From below there is no ground: the sky of radiance 3 is mirrored. 0.015: as above, of 3.
TEST(MirroredGround, IsNotSeenFromBelow) {
    for (const bool native : {true, false}) {
        Scene scene = scene_of_ball(metal(0));
        scene.set_environment(constant_environment(3));
        app::Session session = session_on_ground(scene, GroundMode::shadow);
        session.settings().environment.enabled = true;
        session.settings().camera.position = Vec3d(0, -4.6, 1);
        session.settings().camera.target = Vec3d(0, 0, 0);
        session.allow_native_geometry(native);
        expect_near(mean_of(session), Vec3::Constant(3), 0.015, native ? "native" : "driver");
    }
}

// Of the sun behind the ball that it hides from the place, and of one that it does not hide.
TEST(MirroredGround, ShowsTheShadowOnIt) {
    for (const bool native : {true, false})
        for (const float strength : {0.5f, 1.0f})
            for (const bool behind : {true, false}) {
                Scene scene = scene_of_ball(metal(0));
                scene.set_light("sun", directional(Vec3(0, -1.5f, behind ? 1.0625f : -1.0625f)));
                app::Session session = session_on_ground(scene, GroundMode::shadow);
                session.settings().ground.shadow_strength = strength;
                session.allow_native_geometry(native);
                const float left = behind ? 1 - strength : 1;
                expect_near(mean_of(session), left * linear_from_srgb(page), 0.005,
                            behind ? "behind" : "before");
            }
}

// A plane of this colour in the sun's irradiance 1 has the radiance color / pi below what its gloss reflects,
// of which the environment has none.
TEST(MirroredGround, IsThePlaneInItsLight) {
    const Vec3 color(0.9f, 0.6f, 0.2f);
    for (const bool native : {true, false})
        for (const bool behind : {true, false}) {
            Scene scene = scene_of_ball(metal(0));
            const Vec3 sun = Vec3(0, -1.5f, behind ? 1.0625f : -1.0625f).normalized();
            scene.set_light("sun", directional(sun));
            app::Session session = session_on_ground(scene, GroundMode::plane);
            session.settings().ground.plane_color = color;
            session.allow_native_geometry(native);
            const float lit = behind ? 0 : 0.96f * -sun.y() / float(pi);
            expect_near(mean_of(session), lit * linear_from_srgb(color), 0.005, native ? "native" : "driver");
        }
}

// A wall has the horizon in the middle of its lobe, whatever the roughness: half of the sky's light is left.
// 0.01: the interpolation of the DFG table, and the shift of the dominant direction towards the normal.
TEST(MirroredGround, FillsHalfOfAWallsLobe) {
    for (const float roughness : {0.1f, 0.4f, 0.7f}) {
        Scene scene;
        scene.show(facing_square(1, metal(roughness)), "wall");
        scene.set_environment(constant_environment(1));
        app::Session session = session_on_ground(scene, GroundMode::shadow);
        session.settings().environment.enabled = true;
        session.settings().camera.position = Vec3d(0, 0, 5);
        session.settings().camera.target = Vec3d(0, 0, 0);
        const Vec3 expected = 0.5f * (Vec3::Ones() + linear_from_srgb(page));
        expect_near(mean_of(session), expected, 0.01, "wall");
    }
}

// Light from below that a narrow lobe around the horizon does not see is not taken from what it sees: half of
// 0.5 is left before a black page. 0.02: the prefiltered picture's texels.
TEST(MirroredGround, LeavesTheSkyBesideALightAtTheNadir) {
    Image sky(128, 64, 3, PixelType::f32);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x)
            Eigen::Map<Vec3>(sky.at<float>(x, y)).setConstant(y < 60 ? 0.5f : 20.0f);
    for (const float roughness : {0.1f, 0.3f}) {
        Scene scene;
        scene.show(facing_square(1, metal(roughness)), "wall");
        scene.set_environment(Environment(sky));
        app::Session session = session_on_ground(scene, GroundMode::shadow);
        session.settings().environment.enabled = true;
        session.settings().background.color = Vec3::Zero();
        session.settings().camera.position = Vec3d(0, 0, 5);
        session.settings().camera.target = Vec3d(0, 0, 0);
        expect_near(mean_of(session), Vec3::Constant(0.25f), 0.02, "wall");
    }
}

// A black plane of index 1.5 in a white sky mirrors 0.04 of it near the vertical. 0.005: as above.
TEST(MirroredGround, HasThePlanesGloss) {
    for (const bool native : {true, false}) {
        Scene scene = scene_of_ball(metal(0));
        scene.set_environment(constant_environment(1));
        app::Session session = session_on_ground(scene, GroundMode::plane);
        session.settings().environment.enabled = true;
        session.settings().ground.plane_color = Vec3::Zero();
        session.settings().ground.plane_roughness = 0.1f;
        session.allow_native_geometry(native);
        expect_near(mean_of(session), Vec3::Constant(0.04f), 0.005, native ? "native" : "driver");
    }
}

// Within a room its floor hides the catcher below it.
TEST(MirroredGround, IsNotSeenFromWithinTheContent) {
    Scene scene = scene_of_ball(metal(0.3f));
    scene.show(make_box(Vec3(12, 6, 12)), "room");
    scene.set_environment(constant_environment(1));
    app::Session session = session_on_ground(scene, GroundMode::shadow);
    session.settings().environment.enabled = true;
    session.settings().ground.height = -3.01;
    const Vec3 with = mean_of(session);
    session.settings().ground.mode = GroundMode::none;
    EXPECT_EQ(with, mean_of(session));
}

// Rough metal shows no outline of a shadow: half of a wall's lobe is the ground, which looks the same beside
// the shadow and in it.
TEST(MirroredGround, HasNoShadowInWideLobes) {
    Scene scene = scene_of_ball(metal(0.6f));
    scene.set_light("sun", directional(Vec3(0, -1.5f, 1.0625f)));
    app::Session session = session_on_ground(scene, GroundMode::shadow);
    const Vec3 with = mean_of(session);
    session.settings().ground.shadow_strength = 0;
    expect_near(with, mean_of(session), 1e-6, "ball");
}

// A floor of its own above the ground mirrors nothing of it, however rough and however flat it is seen.
TEST(MirroredGround, IsHiddenByWhatFacesUp) {
    for (const float roughness : {0.1f, 0.4f, 0.7f, 1.0f}) {
        Scene scene;
        scene.show(facing_square(20, metal(roughness)), "floor");
        scene.set_environment(constant_environment(1));
        app::Session session = session_on_ground(scene, GroundMode::shadow);
        session.settings().environment.enabled = true;
        session.settings().background.color = Vec3::Zero();
        session.settings().camera.up = "+z";
        session.settings().camera.position = Vec3d(0, -5, 1);
        session.settings().camera.target = Vec3d(0, 0, 0);
        // A white metal disappears in an even sky; 0.01: the split sum's table.
        expect_near(mean_of(session), Vec3::Ones(), 0.01, "floor");
    }
}

// As paths have it, of all places of the ball. The lobes of the raster frame are those of surfaces seen along
// the normal, its ground is not darkened by the ball's hiding the sky: 0.06 of white on average.
TEST(MirroredGround, IsAsPathsFindIt) {
    for (const float roughness : {0.1f, 0.3f, 0.5f}) {
        Scene scene = scene_of_ball(metal(roughness));
        scene.set_environment(constant_environment(0.3f));
        app::Session session = session_on_ground(scene, GroundMode::shadow);
        Settings& s = session.settings();
        s.environment.enabled = true;
        s.camera.position = Vec3d(0, 0.5, 8);
        s.camera.target = Vec3d(0, 0, 0);
        s.camera.fov_y_deg = 10;
        const Vec3 raster = mean_of(session);
        s.path.enabled = true;
        s.path.denoise = Denoising::off;
        expect_near(raster, mean_of(session, 64), 0.06, "ball");
    }
}

}  // namespace
}  // namespace easypbr::mirrored_ground_test
