// The ground under the content: what it shows is known on paper.
#include "shadow_test.h"

#include "easypbr/scene/resolve.h"

namespace easypbr::ground_test {
namespace {

constexpr int size = 128;

/// A session that catches shadows at z = 0, its camera straight above, `span` wide.
app::Session catcher_session(const Scene& scene, ShadowMode mode, double span) {
    app::Session session = shadow_session(scene, mode, size);
    Settings& s = session.settings();
    s.shadows.enabled = true;
    s.ground.mode = GroundMode::shadow;
    s.ground.height = 0.0;
    s.camera.projection = Projection::orthographic;
    s.camera.ortho_height = span;
    s.camera.target = Vec3d(0, 0, 0);
    s.camera.position = Vec3d(0, 0, 5 * span);
    s.camera.azimuth_deg = 0;
    return session;
}

/// Of the pixel whose centre is nearest to (x, y), for a picture `span` wide whose right is +x and top is +y.
const float* pixel(const Image& image, double x, double y, double span) {
    return image.at<float>(int((x / span + 0.5) * size), int((0.5 - y / span) * size));
}

// A square of side 2 at height 2 in parallel light at 45 degrees: its shadow is the same square, 2 further.
// What is caught is black, premultiplied, with alpha 1, and 0 elsewhere.
TEST(Ground, CatchesAHardShadow) {
    for (const double scale : {0.001, 1.0, 1000.0}) {
        const float s = float(scale);
        Scene scene;
        scene.show(rectangle(-3 * s, -s, -s, s, 2 * s), "card");
        scene.set_light("sun", directional(Vec3(1, 0, -1)));
        app::Session session = catcher_session(scene, ShadowMode::hard, 8 * scale);
        const Image picture = render_linear(session);
        double dark = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const double px = ((x + 0.5) / size - 0.5) * 8, py = (0.5 - (y + 0.5) / size) * 8;
                if (px < -0.9) continue;  // the card itself
                const float* p = picture.at<float>(x, y);
                EXPECT_EQ(p[0] + p[1] + p[2], 0);
                dark += p[3];
                // A texel of the map is 2 / 1018 of the card's side, a pixel 1 / 16.
                const double edge = std::max(std::abs(px), std::abs(py));
                if (edge < 0.98) {
                    EXPECT_EQ(p[3], 1) << px << ", " << py << " at " << scale;
                }
                if (edge > 1.02) {
                    EXPECT_EQ(p[3], 0) << px << ", " << py << " at " << scale;
                }
            }
        // Part of the ground that is shadowed: 900 of its pixels' area is inside by its centre alone; edges
        // lie between pixels (1 / 0.0625 = 16), so that the count is exact but for the map's texels.
        EXPECT_NEAR(dark * 8 * 8 / (size * size), 3.8, 0.21) << scale;
    }
}

// Of two lights that send the same, each shadow takes away a half; strength scales it.
TEST(Ground, ShowsThePartOfTheLightThatIsMissing) {
    Scene scene;
    scene.show(rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 2), "card");
    scene.set_light("left", directional(Vec3(1, 0, -1)));
    scene.set_light("right", directional(Vec3(-1, 0, -1)));
    app::Session session = catcher_session(scene, ShadowMode::hard, 8);
    for (const float strength : {1.0f, 0.5f}) {
        session.settings().ground.shadow_strength = strength;
        const Image picture = render_linear(session);
        // 1e-5: roundings of sums in single precision.
        EXPECT_NEAR(pixel(picture, 2, 0, 8)[3], 0.5 * strength, 1e-5);
        EXPECT_NEAR(pixel(picture, -2, 0, 8)[3], 0.5 * strength, 1e-5);
        EXPECT_EQ(pixel(picture, 0, 3, 8)[3], 0);
    }
    // An environment adds light that no shadow map takes away: radiance L gives pi L beside the sum of the
    // lights' cosines, 2 / sqrt(2).
    session.settings().ground.shadow_strength = 1;
    session.settings().environment.enabled = true;
    session.scene().set_environment(constant_environment(0.5f));
    const double lights = std::sqrt(2.0), sky = pi * 0.5;
    // The irradiance of a constant environment is convolved within 1e-3.
    EXPECT_NEAR(pixel(render_linear(session), 2, 0, 8)[3], lights / 2 / (lights + sky), 1e-3);
}

// A disc light over a knife edge: half of it is seen exactly below the edge, and a still agrees with one
// frame.
TEST(Ground, CatchesPenumbras) {
    Scene scene;
    scene.show(rectangle(0, -3, 6, 3, 1), "edge");
    scene.set_light("lamp", point(Vec3(0, 0, 6), 0.6f));
    app::Session session = catcher_session(scene, ShadowMode::soft, 4);
    session.settings().camera.position = Vec3d(-2.5, 0, 2);  // from beside the edge, under it
    session.settings().camera.target = Vec3d(0, 0, 0);
    session.settings().camera.projection = Projection::perspective;
    session.settings().camera.fov_y_deg = 10;
    // Through the picture's middle the ground is seen at the origin. 0.5 of the disc; its distance and cosine
    // are the same for all of it within 1 %, 64 points of it are even within 0.03, a frame's 16 taps 0.1.
    EXPECT_NEAR(render_linear(session, 64).at<float>(size / 2, size / 2)[3], 0.5, 0.05);
    EXPECT_NEAR(render_linear(session, 1).at<float>(size / 2, size / 2)[3], 0.5, 0.12);
}

/// A box that stands on the ground, whatever axis is up.
TEST(Ground, LiesAtTheFoot) {
    for (const std::string up : {"+y", "-x", "+z"}) {
        Scene scene;
        Mesh box = make_box(Vec3(1, 1, 1));
        box.set_material(matt());
        box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(3, 4, 5)));
        scene.show(box, "box");
        const Vec3d axis = parse_up(up);
        scene.set_light("sun", directional((-axis).cast<float>()));
        app::Session session = shadow_session(scene, ShadowMode::hard, size);
        Settings& s = session.settings();
        s.camera.up = up;
        s.shadows.enabled = true;
        s.ground.mode = GroundMode::shadow;
        const ResolvedSettings resolved = session.resolve(Vec2i(size, size));
        // Lower by 1 / 20000 of the diagonal, so that a floor would hide it.
        EXPECT_NEAR(resolved.settings.ground.height, axis.dot(Vec3d(3, 4, 5)) - 0.5 - 5e-5 * std::sqrt(3.0),
                    1e-6)
            << up;
        EXPECT_TRUE(session.settings().ground.height.value() == std::nullopt) << "before the first picture";
        // The sun in the zenith: all of the shadow is under the box, none is seen.
        const Image picture = render_linear(session);
        int shadowed = 0;
        for (size_t i = 0; i < picture.pixel_count(); ++i) {
            const float* p = picture.pixels<float>().data() + 4 * i;
            shadowed += p[3] > 0 && p[0] + p[1] + p[2] == 0 && p[3] < 1;
        }
        EXPECT_EQ(shadowed, 0) << up;
    }
}

// Where a box touches the ground its shadow begins within 2 texels; at any scale.
TEST(Ground, ShadowsTouchTheContent) {
    for (const double scale : {0.001, 1.0, 1000.0}) {
        const float s = float(scale);
        Scene scene;
        Mesh box = make_box(Vec3(s, s, s));
        box.set_material(matt());
        box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.5 * scale)));
        scene.show(box, "box");
        const Light sun = directional(Vec3(1, 0, -1), 1);
        scene.set_light("sun", sun);
        app::Session session = catcher_session(scene, ShadowMode::soft, 4 * scale);
        session.settings().shadows.resolution = 256;
        const Image picture = render_linear(session);
        const double texel = 2.0 / 250;  // the box's diagonal view is narrower than 2
        for (int x = 0; x < size; ++x) {
            const double px = ((x + 0.5) / size - 0.5) * 4, gap = px - 0.5;
            const float alpha = picture.at<float>(x, size / 2)[3];
            if (gap > 2 * texel && gap < 0.9) {
                EXPECT_GT(alpha, 0.5f) << gap << " at " << scale;
            }
            // And away from the light there is none, to the picture's border.
            if (px < -0.5 - 2 * texel || gap > 1.2) {
                EXPECT_EQ(alpha, 0) << px << " at " << scale;
            }
        }
    }
}

// A ball on the ground under an even sky: what it hides from a point of the ground at distance s from where
// they touch is the cosine-weighted part of the sky that a ball at distance sqrt(s^2 + R^2) covers, (R /
// D)^3. With nothing near the ground is open, to the horizon.
TEST(Ground, CatchesTheOcclusionOfTheSky) {
    Scene scene;
    Mesh ball = make_sphere(0.5f, 64);
    ball.set_material(matt());
    scene.show(ball, "ball");
    scene.set_environment(constant_environment(1));
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.environment.enabled = true;
    s.ssao.enabled = true;
    s.ground.mode = GroundMode::shadow;
    s.camera.elevation_deg = 20;
    s.camera.margin = 0.7f;
    const Image narrow = render_linear(session);
    s.camera.elevation_deg = 40;
    s.camera.position.release();
    s.camera.target.release();
    s.ssao.radius = 100.0f;
    s.ssao.directions = 8;
    s.ssao.steps = 16;
    const Image wide = render_linear(session, 16);
    const Camera camera = session.camera();
    const Mat4d clip = camera.projection_matrix(1);
    int known = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            // An open plane's visibility is at least 0.98.
            if (std::hypot(x - size / 2, y - size / 2) > 40) {
                EXPECT_LT(narrow.at<float>(x, y)[3], 0.02f) << x << ", " << y;
            }
            const float* p = wide.at<float>(x, y);
            if (p[0] > 0) continue;
            const Vec3d d = camera.T_world_cam.linear() * Vec3d(((x + 0.5) / size * 2 - 1) / clip(0, 0),
                                                                (1 - (y + 0.5) / size * 2) / clip(1, 1), -1);
            const Vec3d at = camera.position() + d * ((-0.5 - camera.position().y()) / d.y());
            const double from_touch = std::hypot(at.x(), at.z());
            // In front of the ball: what is behind it is not in the depth buffer.
            if (from_touch < 0.5 || from_touch > 1.5 || at.z() < 0.3) continue;
            EXPECT_NEAR(p[3], std::pow(0.5 / std::hypot(from_touch, 0.5), 3), 0.05) << from_touch;
            ++known;
        }
    EXPECT_GT(known, 100);
}

// What lies behind the ground shows through: a background times what is left of the light.
TEST(Ground, DarkensTheEnvironmentBehind) {
    Scene scene;
    scene.show(rectangle(-3, -1, -1, 1, 2), "card");
    scene.set_environment(constant_environment(0.5f));
    scene.set_light("sun", directional(Vec3(1, 0, -1)));
    app::Session session = catcher_session(scene, ShadowMode::hard, 8);
    session.settings().environment.enabled = true;
    const Image alone = render_linear(session);
    session.settings().background.mode = BackgroundMode::environment;
    const Image over = render_linear(session);
    const float alpha = pixel(alone, 0, 0, 8)[3];
    EXPECT_GT(alpha, 0.2f);
    EXPECT_NEAR(pixel(over, 0, 0, 8)[0], 0.5 * (1 - alpha), 1e-4);
    EXPECT_EQ(pixel(over, 0, 0, 8)[3], 1);
    EXPECT_NEAR(pixel(over, 3, 3, 8)[0], 0.5, 1e-4);
}

// The plane of mode plane is what a large square of the same material is, until it fades.
TEST(Ground, PlaneIsASurface) {
    Material material;
    material.base_color = Vec3(0.2f, 0.4f, 0.6f);
    material.roughness = 0.5f;
    Scene scene;
    scene.show(rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 1), "card");
    scene.set_light("lamp", point(Vec3(1, -1, 4)));
    app::Session session = shadow_session(scene, ShadowMode::pcf, size);
    Settings& s = session.settings();
    s.shadows.enabled = true;
    look_from(session, Vec3d(2, -3, 3), 40);
    s.ground.mode = GroundMode::plane;
    s.ground.height = 0.0;
    s.ground.plane_color =
        Vec3(0.48452920448170694f, 0.66519138507f, 0.79773998775f);  // sRGB of the material's
    s.ground.plane_roughness = 0.5f;
    s.ground.radius = 1000.0f;
    const Image own = render_linear(session);
    s.ground.mode = GroundMode::none;
    scene.show(rectangle(-20, -20, 20, 20, 0, material), "floor");
    // The floor must not change the fit of the shadow map: it is kept out of the way of the light.
    const Image mesh = render_linear(session);
    int same = 0, pixels = 0;
    for (size_t i = 0; i < own.pixel_count(); ++i) {
        const float *a = own.pixels<float>().data() + 4 * i, *b = mesh.pixels<float>().data() + 4 * i;
        if (a[3] < 1 || b[3] < 1) continue;
        ++pixels;
        same += std::abs(a[2] - b[2]) < 2e-3f * std::max(b[2], 0.01f);
    }
    EXPECT_GT(pixels, size * size * 9 / 10);
    // All but the shadow's edge, which the coarser map of the larger scene draws elsewhere.
    EXPECT_GT(same, pixels * 97 / 100);

    scene.remove("floor");
    s.ground.mode = GroundMode::plane;
    s.ground.radius = 2.0f;
    EXPECT_EQ(render_linear(session).at<float>(2, 2)[3], 0) << "faded";
}

TEST(Ground, IsSeenFromAboveOnlyAndInNoLayer) {
    Scene scene;
    scene.show(rectangle(-0.5f, -0.5f, 0.5f, 0.5f, 1), "card");
    scene.set_light("sun", directional(Vec3(0.3f, 0, -1)));
    app::Session session = shadow_session(scene, ShadowMode::hard, size);
    session.settings().shadows.enabled = true;
    session.settings().ground.mode = GroundMode::plane;
    session.settings().ground.height = 0.0;
    look_from(session, Vec3d(0, -3, 2), 40);
    EXPECT_GT(render_linear(session).at<float>(4, size - 4)[3], 0.5f);
    EXPECT_EQ(session.render_layers({"depth"}).at("depth").at<float>(4, size - 4)[0], 0);
    EXPECT_EQ(session.render_layers({"object_id"}).at("object_id").at<float>(4, size - 4)[0], 0);
    look_from(session, Vec3d(0, -3, -2), 40);
    const Image below = render_linear(session);
    EXPECT_EQ(below.at<float>(4, size - 4)[3], 0);
    EXPECT_EQ(below.at<float>(4, 4)[3], 0);
}

TEST(Ground, ANothingHasNone) {
    app::Session session = plain_session(Scene(), 32);
    session.settings().ground.mode = GroundMode::shadow;
    session.settings().camera.position = Vec3d(0, 1, 4);
    session.settings().camera.target = Vec3d(0, 0, 0);
    session.settings().camera.near = 0.01;
    const Image picture = render_linear(session);
    for (const float v : picture.pixels<float>()) EXPECT_EQ(v, 0);
}

}  // namespace
}  // namespace easypbr::ground_test
