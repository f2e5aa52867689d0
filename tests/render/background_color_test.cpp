// What mirrors and glass show of a background of one colour, and of the ground that catches shadows before
// it.
#include <cmath>

#include "easypbr/core/color.h"
#include "render_test.h"

namespace easypbr::background_color_test {
namespace {

constexpr int size = 16;

app::Session session_before(const Scene& scene, const Vec3& color) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.path.clamp = 0;
    s.path.denoise = Denoising::off;
    s.shadows.enabled = true;
    s.background.mode = BackgroundMode::color;
    s.background.color = color;
    s.ground.mode = GroundMode::none;
    return session;
}

Material glass(const Vec3& color, float thickness) {
    Material m;
    m.base_color = color;
    m.roughness = 0;
    m.transmission = 1;
    m.thickness = thickness;
    return m;
}

Material mirror() {
    Material m;
    m.base_color = Vec3::Ones();
    m.roughness = 0;
    m.metallic = 1;
    return m;
}

Vec3 mean_of(const Image& image) {
    Vec3 sum = Vec3::Zero();
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += Vec3(image.at<float>(x, y));
    return sum / float(image.pixel_count());
}

constexpr double face = 0.96;  ///< what a face of index 1.5 lets through, at right angles

Scene slab_scene() {
    Scene scene;
    Mesh slab = make_box(Vec3(4, 4, 1));
    slab.set_material(glass(Vec3::Ones(), 1));
    scene.show(slab, "slab");
    return scene;
}

// A slab before a colour shows what its two faces let through, and of the black around nothing. The radiance
// is such that exposure makes the colour of it. 0.01: nine of ten paths go through, of 64 in each of 256
// pixels, whose mean is off by 0.003.
TEST(BackgroundColor, ASlabShowsItsTransmittance) {
    const Vec3 color(1, 0.5f, 0.25f);
    for (const float exposure : {1.0f, 2.0f}) {
        app::Session session = session_before(slab_scene(), color);
        session.settings().path.enabled = true;
        session.settings().tonemap.exposure = exposure;
        look_from(session, Vec3d(0, 0, 8), 1);
        const Vec3 seen = mean_of(render_linear(session, 64));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[c] * exposure, face * face * linear_from_srgb(color[c]), 0.01) << exposure;
    }
}

// The same as codes: 245.6 of 255 for 0.9216. 1: a hundredth of light near white is more.
TEST(BackgroundColor, ASlabIsNearlyWhiteBeforeWhite) {
    app::Session session = session_before(slab_scene(), Vec3::Ones());
    session.settings().path.enabled = true;
    look_from(session, Vec3d(0, 0, 8), 1);
    const Image image = session.render({std::nullopt, 256});
    double sum = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) sum += image.at<uint8_t>(x, y)[0];
    EXPECT_NEAR(sum / (size * size), 255 * double(srgb_from_linear(float(face * face))), 1);
}

// An environment behind frosted glass is not seen beside the colour: the pane reflects 0.04 of it, in both
// ways of drawing. 0.02: the lobe's part that facets at a roughness of 0.3 turn back, and noise.
TEST(BackgroundColor, PanesShowTheColorInPlaceOfTheEnvironment) {
    const Vec3 tint(1, 0.5f, 0.25f);
    for (const bool paths : {false, true})
        for (const bool native : {true, false})
            for (const float roughness : {0.0f, 0.3f}) {
                Scene scene;
                Material pane = glass(tint, 0);
                pane.roughness = roughness;
                scene.show(facing_square(2, pane), "pane");
                scene.set_environment(constant_environment(3));
                app::Session session = session_before(scene, Vec3::Ones());
                session.allow_native_geometry(native);
                session.settings().environment.enabled = true;
                session.settings().path.enabled = paths;
                look_from(session, Vec3d(0, 0, 8), 1);
                const Vec3 seen = mean_of(render_linear(session, paths ? 256 : 1));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen[c], face * tint[c] + 0.04 * 3, 0.02)
                        << paths << ", " << native << ", " << roughness;
            }
}

// The environment stays behind transparent pictures.
TEST(BackgroundColor, NothingIsSeenOfItInTransparentPictures) {
    Scene scene = slab_scene();
    scene.set_environment(constant_environment(0.25f));
    app::Session session = session_before(scene, Vec3::Ones());
    session.settings().background.mode = BackgroundMode::transparent;
    session.settings().environment.enabled = true;
    session.settings().path.enabled = true;
    look_from(session, Vec3d(0, 0, 8), 1);
    const Image image = render_linear(session, 64);
    // All of an even sky: 0.002 are roundings of the table of directional albedos.
    EXPECT_NEAR(mean_of(image).x(), 0.25, 0.002);
    EXPECT_EQ(image.at<float>(size / 2, size / 2)[3], 1.0f);
}

constexpr double height = 1.5;

/// A ball on a ground that catches shadows, under an even sky of radiance 1; the picture shows the place
/// (0, -0.6, 0.8) of the ball, from ahead.
app::Session session_of_ball(const Material& material, const Vec3& color) {
    Scene scene;
    Mesh ball = make_sphere(1, 256);
    ball.set_material(material);
    scene.show(ball, "ball");
    scene.set_environment(constant_environment(1));
    app::Session session = session_before(scene, color);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.environment.enabled = true;
    s.ground.mode = GroundMode::shadow;
    s.ground.height = -height;
    s.camera.position = Vec3d(0, -0.6, 4.6);
    s.camera.target = Vec3d(0, -0.6, 0);
    s.camera.fov_y_deg = 1;
    return session;
}

// A mirror turns the direction (0, 0, -1) to (0, -0.96, 0.28), which meets the ground 1.0625 from the foot of
// the ball. There the ball hides h / d^3 of an even sky, where h is the height of its middle and d the way to
// it. 0.01 of the colour: the noise of 64 samples in 256 pixels is 0.0035 of it.
TEST(BackgroundColor, MirrorsShowTheGroundInTheBackgroundsColor) {
    const Vec3 color(0.8f, 0.5f, 0.3f);
    const double distance = std::hypot(1.0625, height), hidden = height / std::pow(distance, 3);
    for (const float strength : {0.0f, 1.0f}) {
        app::Session session = session_of_ball(mirror(), color);
        session.settings().ground.shadow_strength = strength;
        const Vec3 seen = mean_of(render_linear(session, 64));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[c] / linear_from_srgb(color[c]), 1 - double(strength) * hidden, 0.01)
                << strength;
    }
}

// The catcher has no edge, whatever the radius is at which a plane fades. Places of the ball that are turned
// down by 2.9 degrees mirror the ground 15 from its foot, those of the picture 9 to 40. 0.01: as above.
TEST(BackgroundColor, MirrorsShowTheGroundToTheHorizon) {
    const Vec3 color(0.8f, 0.5f, 0.3f);
    app::Session session = session_of_ball(mirror(), color);
    Settings& s = session.settings();
    s.ground.radius = 3.0f;
    s.camera.position = Vec3d(0, -0.05006, 4.6);
    s.camera.target = Vec3d(0, -0.05006, 0);
    const Vec3 seen = mean_of(render_linear(session, 16));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / linear_from_srgb(color[c]), 1, 0.01);
}

// Matt surfaces get no light of it: the picture is the same but for rounded numbers, and directions that are
// mirrored at faces of the ball.
TEST(BackgroundColor, LightsNothing) {
    Material matt;
    matt.base_color = Vec3::Constant(0.8f);
    matt.roughness = 1;
    matt.specular = 0;
    const auto seen = [&](const Vec3& color) {
        app::Session session = session_of_ball(matt, color);
        return mean_of(render_linear(session, 16)).x();
    };
    EXPECT_NEAR(seen(Vec3::Ones()), seen(Vec3::Zero()), 1e-3);
}

}  // namespace
}  // namespace easypbr::background_color_test
