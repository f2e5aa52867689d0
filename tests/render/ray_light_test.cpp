// The sky's light and reflections of the scene by rays, against closed forms.
#include <functional>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"
#include "gpu_rounding.h"
#include "shadow_test.h"

namespace easypbr::ray_light_test {
namespace {

/// Reflects a part of all light evenly and nothing like a mirror.
Material diffuse(float albedo) {
    Material m;
    m.base_color = Vec3::Constant(albedo);
    m.roughness = 1;
    m.specular = 0;
    return m;
}

Material glowing(const Vec3& radiance) {
    Material m;
    m.base_color = radiance;
    m.unlit = true;
    return m;
}

Material mirror() {
    Material m;
    m.base_color = Vec3::Ones();
    m.metallic = 1;
    m.roughness = 0;
    return m;
}

Mesh box_at(const Vec3& size, const Vec3d& centre, const Material& material) {
    Mesh box = make_box(size);
    box.set_material(material);
    box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(centre)));
    return box;
}

/// Looks straight down on z = 0, `span` wide; lit by the sky alone.
app::Session sky_session(const Scene& scene, int size, double span) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.environment.enabled = true;
    s.shadows.enabled = true;
    s.ssao.enabled = true;
    s.camera.up = "+z";
    s.camera.projection = Projection::orthographic;
    s.camera.ortho_height = span;
    s.camera.target = Vec3d(0, 0, 0);
    s.camera.position = Vec3d(0, 0, 5 * span);
    s.camera.azimuth_deg = 0;
    return session;
}

/// Dark below the horizon of +z and above it but for a disc around a direction (+z up).
Environment bright_disc(const Vec3& towards, float radius_deg, float radiance) {
    Image image(256, 128, 3, PixelType::f32);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            // The environment's +y is the world's up, +z; its -z is +y.
            const Vec3 e = equirect_direction((float(x) + 0.5f) / 256, (float(y) + 0.5f) / 128);
            const Vec3 d(e.x(), -e.z(), e.y());
            const bool in = d.dot(towards.normalized()) > std::cos(radians(radius_deg));
            std::fill_n(image.at<float>(x, y), 3, in ? radiance : 0.0f);
        }
    return Environment(image);
}

double largest_difference(const Image& a, const Image& b) {
    double largest = 0;
    for (size_t i = 0; i < a.pixel_count() * 4; ++i)
        largest = std::max(largest, double(std::abs(a.pixels<float>()[i] - b.pixels<float>()[i])));
    return largest;
}

// Two panes, which are almost clear, lie over a white floor under a white sky: it is as bright as without
// them, for what rays find at a layer counts for that layer alone.
TEST(RayLight, LayersLeaveTheLightBehindThemAsItIs) {
    Scene scene;
    scene.set_environment(constant_environment(1));
    scene.show(box_at(Vec3(8, 8, 0.1f), Vec3d(0, 0, -0.1), diffuse(1)), "floor");
    Material clear = diffuse(1);
    clear.opacity = 0.01f;
    clear.alpha_mode = AlphaMode::blend;
    for (const double z : {0.5, 1.0})
        scene.show(box_at(Vec3(8, 8, 0.02f), Vec3d(0, 0, z), clear), z < 1 ? "lower" : "upper");
    app::Session session = sky_session(scene, 32, 2);
    session.settings().rays.enabled = true;
    session.settings().path.enabled = false;
    const Image image = render_linear(session, 8);
    // The panes are hit by a hundredth of the rays each, twice.
    for (int i = 0; i < 32; i += 5) EXPECT_NEAR(image.at<float>(i, 16)[0], 1, 0.06) << i;
}

// Nothing is in the way of a plane and a ball: their light is what it is without rays, and without noise.
// 1e-3: the open sky's part is stored in 16-bit floats, of 2^-11.
TEST(RayLight, ChangesNothingInTheOpen) {
    for (const bool ball : {false, true}) {
        Scene scene;
        Mesh mesh = ball ? make_sphere(1, 64) : facing_square(1);
        Material m;
        m.roughness = 0.5f;
        mesh.set_material(m);
        scene.show(mesh, "mesh");
        scene.set_environment(bright_disc({1, 1, 1}, 40, 3));
        app::Session session = sky_session(scene, 64, 3);
        session.settings().ssao.enabled = false;
        session.settings().rays.enabled = false;
        const Image without = render_linear(session, 4);
        session.settings().rays.enabled = true;
        const Image with = render_linear(session, 4);
        float most = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const float *a = with.at<float>(x, y), *b = without.at<float>(x, y);
                // A GPU's borders are not the rays'.
                if (has_gpu() && (a[3] < 1 || b[3] < 1)) continue;
                for (int c = 0; c < 4; ++c) most = std::max(most, std::abs(a[c] - b[c]));
            }
        EXPECT_LT(most, 1e-3f) << ball;
    }
}

/// A floor of albedo 1 at z = 0 beside a wall of height 1 along y, at x = 0, `length` to either side.
Scene floor_and_wall(double scale, const Material& wall, float length = 40) {
    const auto s = float(scale);
    Scene scene;
    scene.show(rectangle(-0.5f * s, -s, 4 * s, s, 0, diffuse(1)), "floor");
    scene.show(box_at({0.2f * s, 2 * length * s, s}, {-0.1 * scale, 0, 0.5 * scale}, wall), "wall");
    return scene;
}

/// Mean radiance of the floor's pixels at a distance from the wall, in a picture 4 wide around x = 1.
double floor_at(const Image& picture, double distance) {
    const int w = picture.width(), h = picture.height(), x = int((distance + 1) / 4 * w);
    double sum = 0;
    for (int y = h / 4; y < h * 3 / 4; ++y) sum += picture.at<float>(x, y)[1] / (h / 2);
    return sum;
}

app::Session wall_session(const Scene& scene, double scale) {
    app::Session session = sky_session(scene, 64, 4 * scale);
    session.settings().camera.target = Vec3d(scale, 0, 0);
    session.settings().camera.position = Vec3d(scale, 0, 20 * scale);
    return session;
}

// A floor at distance d from a wall of height h without end loses (1 - d / sqrt(d^2 + h^2)) / 2 of an even
// sky. 0.01: 32 pixels of 256 rays each are even within 0.005; the wall is 40 long, not without end. At any
// scale.
TEST(RayLight, AWallHidesTheSky) {
    for (const double scale : {0.001, 1.0, 1000.0}) {
        Scene scene = floor_and_wall(scale, diffuse(0));
        scene.set_environment(constant_environment(1));
        app::Session session = wall_session(scene, scale);
        const Image picture = render_linear(session, 64);
        for (const double d : {0.1, 0.25, 0.5, 1.0, 2.0}) {
            const double at = (std::floor((d + 1) * 16) + 0.5) / 16 - 1;  // the pixel's middle
            EXPECT_NEAR(floor_at(picture, d), 1 - (1 - at / std::hypot(at, 1.0)) / 2, 0.01)
                << d << " at " << scale;
        }
    }
}

// The same wall glows: what it hides it gives back in its own colour. With the sky's radiance the floor does
// not know of it (the furnace).
TEST(RayLight, AGlowingWallGivesBack) {
    Scene scene = floor_and_wall(1, glowing({1, 1, 1}));
    scene.set_environment(constant_environment(1));
    app::Session session = wall_session(scene, 1);
    // A white floor keeps within 1e-3 what the DFG table says it does.
    for (const double d : {0.1, 0.5, 2.0}) EXPECT_NEAR(floor_at(render_linear(session, 32), d), 1, 2e-3) << d;
    scene.show(box_at({0.2f, 80, 1}, {-0.1, 0, 0.5}, glowing({0, 3, 0})), "wall");
    const Image picture = render_linear(session, 64);
    const double d = (std::floor(1.25 * 16) + 0.5) / 16 - 1, hidden = (1 - d / std::hypot(d, 1.0)) / 2;
    EXPECT_NEAR(floor_at(picture, 0.25), 1 - hidden + 3 * hidden, 0.03);
    EXPECT_NEAR(picture.at<float>(20, 32)[0], 1 - hidden, 0.06);  // one pixel of 256 rays
}

// White surfaces under an even white sky: all of it comes back however often it is reflected, but for paths
// that are cut after three surfaces more. From the corner of floor and wall half of the light meets the
// other; at least half of it leaves there, so that at most 0.5^4 is lost, and less further on.
TEST(RayLight, HoldsTheFurnace) {
    Scene scene = floor_and_wall(1, diffuse(1));
    scene.set_environment(constant_environment(1));
    app::Session session = wall_session(scene, 1);
    const Image picture = render_linear(session, 64);
    EXPECT_NEAR(floor_at(picture, 0.05), 1, 0.0625);
    EXPECT_NEAR(floor_at(picture, 0.5), 1, 0.02);
    EXPECT_NEAR(floor_at(picture, 2), 1, 0.01);
}

// Light from one side: behind a screen there is none, before it there is all, where occlusion by closeness
// would see two even sides. 0.03: the penumbra of 20 degrees is left out, 64 frames of rays remain.
TEST(RayLight, TheSkyCastsShadows) {
    Scene scene;
    scene.show(rectangle(-4, -4, 4, 4, 0, diffuse(1)), "floor");
    scene.show(box_at({0.1f, 8, 1}, {0, 0, 0.5}, diffuse(0)), "screen");
    scene.set_environment(bright_disc({1, 0, 1}, 10, 20));
    app::Session session = sky_session(scene, 64, 8);
    session.settings().environment.sun = false;
    session.settings().rays.enabled = false;
    session.settings().ssao.enabled = false;
    const Image open = render_linear(session, 4);
    session.settings().rays.enabled = true;
    const Image picture = render_linear(session, 64);
    // The bright disc at 35 to 55 degrees over +x: shadows reach from x = -0.05 to -0.7 in full, half shadows
    // to -1.5.
    const auto part = [&](double x) {
        const int column = int((x / 8 + 0.5) * 64);
        return picture.at<float>(column, 32)[1] / open.at<float>(column, 32)[1];
    };
    EXPECT_GT(open.at<float>(8, 32)[1], 0.1f);
    EXPECT_NEAR(part(-0.3), 0, 0.03);
    EXPECT_NEAR(part(-2), 1, 0.03);
    EXPECT_NEAR(part(0.3), 1, 0.03);
    EXPECT_NEAR(part(3), 1, 0.03);
}

// A floor that is a mirror shows a glowing card over it where geometry says, and the sky elsewhere.
TEST(RayLight, AMirrorShowsTheScene) {
    Scene scene;
    scene.show(rectangle(-4, -4, 4, 4, 0, mirror()), "floor");
    // Upright, facing the camera, from z = 0.5 to 1.5 at y = 1.
    Mesh card = rectangle(-0.75f, -0.5f, 0.75f, 0.5f, 0, glowing({1, 0, 0}));
    card.set_T_parent_mesh(
        Eigen::Affine3d(Eigen::Translation3d(0, 1, 1) * Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())));
    scene.show(card, "card");
    scene.set_environment(constant_environment(0.25f));
    app::Session session = sky_session(scene, 96, 4);
    session.settings().camera.projection = Projection::perspective;
    session.settings().camera.azimuth_deg = 0;
    look_from(session, Vec3d(0.3, -4, 2.5), 50);
    const Image picture = render_linear(session, 32);
    const Image depth = session.render_layers({"depth"}).at("depth");
    const LitParts seen{Image(), depth, session.camera()};
    const Vec3d eye = session.camera().position();
    int in = 0, out = 0;
    for (int y = 1; y < 95; ++y)
        for (int x = 1; x < 95; ++x) {
            if (depth.at<float>(x, y)[0] <= 0) continue;
            const Vec3d p = seen.position(x, y);
            if (std::abs(p.z()) > 1e-3 || p.y() > 0.95) continue;
            Vec3d d = (p - eye).normalized();
            d.z() = -d.z();
            const Vec3d at = p + d * ((1 - p.y()) / d.y());
            // Off the image's edges by more than a pixel.
            const double inside = std::min(0.75 - std::abs(at.x()), 0.5 - std::abs(at.z() - 1));
            if (std::abs(inside) < 0.1) continue;
            const float* c = picture.at<float>(x, y);
            // White metal: all of it is reflected. The scene's light is stored in 16-bit floats.
            EXPECT_NEAR(c[0], inside > 0 ? 1 : 0.25, 2e-3) << x << ", " << y;
            EXPECT_NEAR(c[1], inside > 0 ? 0 : 0.25, 2e-3) << x << ", " << y;
            (inside > 0 ? in : out) += 1;
        }
    EXPECT_GT(in, 100);
    EXPECT_GT(out, 1000);
}

/// Part of a hemisphere, weighted by the cosine, that a rectangle from a corner opposite to the surface
/// covers, of sides a and b at distance 1 (Howell, A Catalog of Radiation Heat Transfer Configuration
/// Factors, B-4).
double corner_factor(double a, double b) {
    const auto half = [](double x, double y) {
        const double root = std::sqrt(1 + x * x);
        return x / root * std::atan(y / root);
    };
    return (half(a, b) + half(b, a)) / (2 * pi);
}

// Texels of floats show the same in a mirror as where they are seen: light above 1 is 1, and half of a number
// is code 128 (to half a code, which the light of a card of which a part is metal follows).
TEST(RayLight, AMirrorShowsTexelsAsTheyAreSeen) {
    const auto picture_of = [](PixelType type, bool emits) {
        auto image = std::make_shared<Image>(1, 1, 1, type);
        if (type == PixelType::u8)
            image->at<uint8_t>(0, 0)[0] = emits ? 255 : 128;
        else
            image->at<float>(0, 0)[0] = emits ? 4.0f : 0.5f;
        Material m;
        m.base_color = Vec3::Ones();
        (emits ? m.emissive_texture : m.metallic_texture).image = image;
        if (emits) m.emissive = Vec3::Ones();
        if (!emits) m.metallic = 1;
        Scene scene;
        scene.show(rectangle(-4, -4, 4, 4, 0, mirror()), "floor");
        // Upright, facing the camera, as above.
        Mesh card = facing_square(0.5f, m);
        card.set_T_parent_mesh(
            Eigen::Affine3d(Eigen::Translation3d(0, 1, 1) * Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())));
        scene.show(card, "card");
        scene.set_environment(constant_environment(0.25f));
        app::Session session = sky_session(scene, 48, 4);
        session.settings().rays.enabled = true;
        session.settings().camera.projection = Projection::perspective;
        look_from(session, Vec3d(0.3, -4, 2.5), 50);
        return render_linear(session, 8);
    };
    EXPECT_EQ(largest_difference(picture_of(PixelType::u8, true), picture_of(PixelType::f32, true)), 0);
    EXPECT_LE(largest_difference(picture_of(PixelType::u8, false), picture_of(PixelType::f32, false)), 2e-3);
}

// A mirror shows a white card that a large lamp stands before. 0.01: some thousand points of the lamp, whose
// parts differ by half, and the edges' normals. Its middle alone gives 0.66 of it.
TEST(RayLight, AMirrorShowsWhatALargeLampLights) {
    constexpr double half = 0.6, distance = 0.5;
    Scene scene;
    scene.show(rectangle(-4, -4, 4, 4, 0, mirror()), "floor");
    Mesh card = rectangle(-0.75f, -0.5f, 0.75f, 0.5f, 0, diffuse(1));
    card.set_T_parent_mesh(
        Eigen::Affine3d(Eigen::Translation3d(0, 1, 1) * Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())));
    scene.show(card, "card");
    Light lamp;
    lamp.type = LightType::rectangle;
    lamp.position = Vec3d(0, 1 - distance, 1);
    lamp.direction = Vec3(0, 1, 0);
    lamp.size = Vec2(float(2 * half), float(2 * half));
    lamp.intensity = 1;
    scene.set_light("lamp", lamp);
    scene.set_environment(constant_environment(1e-4f));  // rays look for one
    app::Session session = sky_session(scene, 96, 4);
    Settings& s = session.settings();
    s.shading.dielectric_f0 = 0;
    s.rays.enabled = true;
    s.camera.projection = Projection::perspective;
    look_from(session, Vec3d(0.3, -4, 2.5), 50);
    const Image picture = render_linear(session, 64);
    const Image depth = session.render_layers({"depth"}).at("depth");
    const LitParts seen{Image(), depth, session.camera()};
    const Vec3d eye = session.camera().position();
    double shown = 0, expected = 0;
    int pixels = 0;
    for (int y = 1; y < 95; ++y)
        for (int x = 1; x < 95; ++x) {
            if (depth.at<float>(x, y)[0] <= 0) continue;
            const Vec3d p = seen.position(x, y);
            if (std::abs(p.z()) > 1e-3 || p.y() > 0.4) continue;
            Vec3d d = (p - eye).normalized();
            d.z() = -d.z();
            const Vec3d at = p + d * ((1 - p.y()) / d.y());
            if (std::min(0.75 - std::abs(at.x()), 0.5 - std::abs(at.z() - 1)) < 0.1) continue;
            const double left = (half + at.x()) / distance, right = (half - at.x()) / distance,
                         below = (half + at.z() - 1) / distance, above = (half - at.z() + 1) / distance;
            shown += double(picture.at<float>(x, y)[0]);
            expected += corner_factor(left, below) + corner_factor(left, above) +
                        corner_factor(right, below) + corner_factor(right, above);
            ++pixels;
        }
    EXPECT_GT(pixels, 100);
    EXPECT_NEAR(shown / expected, 1, 0.01);
}

/// A floor under a lid at height 1 over the half x > 0, and what becomes of the floor's light in its middle.
double under_lid(const std::function<void(Scene&)>& add_lid) {
    Scene scene;
    scene.show(rectangle(-1, -1, 1, 1, 0, diffuse(1)), "floor");
    add_lid(scene);
    scene.set_environment(bright_disc({1, 0, 1}, 5, 50));
    app::Session session = sky_session(scene, 33, 1);
    session.settings().environment.sun = false;
    session.settings().camera.position = Vec3d(-2, 0, 3);
    session.settings().camera.projection = Projection::perspective;
    session.settings().camera.fov_y_deg = 5;
    session.settings().rays.enabled = false;
    session.settings().ssao.enabled = false;
    const double open = render_linear(session, 4).at<float>(16, 16)[1];
    session.settings().rays.enabled = true;
    return render_linear(session, 16).at<float>(16, 16)[1] / open;
}

Mesh lid(const Material& material) {
    return rectangle(0.2f, -1, 3, 1, 1, material);
}

/// A grid 0.02 apart at z = 1, facing down.
Mesh splats(bool normals, bool surfels) {
    MeshData data;
    Array3f::Dense V(81 * 81, 3), N(81 * 81, 3);
    for (int i = 0; i < V.rows(); ++i) {
        V.row(i) << 0.2f + 0.02f * float(i % 81), -0.8f + 0.02f * float(i / 81), 1;
        N.row(i) << 0, 0, -1;
    }
    data.V = Array3f(V);
    if (normals) data.N = Array3f(N);
    data.style.mode = surfels ? DrawMode::surfels : DrawMode::points;
    data.style.point_size = 0.04f;
    data.style.point_size_unit = SizeUnit::world;
    data.materials = {diffuse(0)};
    return Mesh(data);
}

// Light from 45 degrees over +x passes x = 1 at height 1. 0.08: one pixel of 256 rays, of which a half is
// stopped, as 1 / (2 sqrt(256)) and twice that.
TEST(RayLight, AllKindsOfCastersStopIt) {
    EXPECT_NEAR(under_lid([](Scene&) {}), 1, 0.01);
    EXPECT_NEAR(under_lid([](Scene& scene) { scene.show(lid(diffuse(0)), "lid"); }), 0, 0.01);
    EXPECT_NEAR(under_lid([](Scene& scene) {
                    Material half = diffuse(0);
                    half.opacity = 0.5f;
                    half.alpha_mode = AlphaMode::blend;
                    scene.show(lid(half), "lid");
                }),
                0.5, 0.08);
    // The light's path goes through the texture at u = (1 - 0.2) / 2.8: in the half that is a hole, or not.
    for (const bool hole : {true, false}) {
        EXPECT_NEAR(under_lid([&](Scene& scene) {
                        Image image(2, 1, 4, PixelType::u8);
                        image.at<uint8_t>(hole ? 1 : 0, 0)[3] = 255;
                        Material masked = diffuse(0);
                        masked.base_color_texture.image = std::make_shared<Image>(image);
                        masked.alpha_mode = AlphaMode::mask;
                        scene.show(lid(masked), "lid");
                    }),
                    hole ? 1 : 0, 0.01);
    }
    // A grid of points as wide as their distance, without and with normals, and of surfels.
    for (const int kind : {0, 1, 2})
        EXPECT_NEAR(under_lid([&](Scene& scene) { scene.show(splats(kind > 0, kind == 2), "lid"); }), 0, 0.05)
            << kind;
}

// A ball on the ground hides (R / D)^3 of an even sky; the ground that catches shadows shows that,
// everywhere: also behind the ball, where a depth buffer knows nothing.
TEST(RayLight, TheGroundCatchesIt) {
    Scene scene;
    Mesh ball = make_sphere(0.5f, 64);
    ball.set_material(diffuse(0));
    ball.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.5)));
    scene.show(ball, "ball");
    scene.set_environment(constant_environment(1));
    app::Session session = sky_session(scene, 64, 4);
    session.settings().ground.mode = GroundMode::shadow;
    const Image picture = render_linear(session, 64);
    for (int x = 0; x < 64; ++x) {
        const double from_touch = std::abs((x + 0.5) / 64 - 0.5) * 4;
        if (from_touch < 0.55) continue;
        // The row beside the middle; one pixel of 256 rays, up to 0.35 of which are stopped.
        EXPECT_NEAR(picture.at<float>(x, 32)[3], std::pow(0.5 / std::hypot(from_touch, 0.5), 3), 0.05)
            << from_touch;
    }
}

// What a material's occlusion says and what rays find overlap: the darker counts, once.
TEST(RayLight, OcclusionMapsCountOnce) {
    for (const double own : {0.25, 1.0}) {
        Scene scene = floor_and_wall(1, diffuse(0));
        Material material = diffuse(1);
        Image image(1, 1, 1, PixelType::u8);
        image.at<uint8_t>(0, 0)[0] = uint8_t(own * 255);
        material.occlusion_texture.image = std::make_shared<Image>(image);
        scene.show(rectangle(-0.5f, -1, 4, 1, 0, material), "floor");
        scene.set_environment(constant_environment(1));
        app::Session session = wall_session(scene, 1);
        session.settings().ssao.multi_bounce = false;
        const Image picture = render_linear(session, 64);
        const double at = (std::floor(1.1 * 16) + 0.5) / 16 - 1;
        EXPECT_NEAR(floor_at(picture, 0.1), std::min(own, 1 - (1 - at / std::hypot(at, 1.0)) / 2), 0.02)
            << own;
        EXPECT_NEAR(floor_at(picture, 2.5), std::min(own, 0.96), 0.02) << own;
    }
}

TEST(RayLight, IsTheSameEveryTime) {
    Scene scene = floor_and_wall(1, diffuse(0.5f));
    scene.set_environment(bright_disc({1, 1, 1}, 30, 3));
    app::Session session = wall_session(scene, 1);
    EXPECT_EQ(largest_difference(render_linear(session, 32), render_linear(session, 32)), 0);
}

// Pictures of few samples are drawn without; more rays than one picture can count are an error.
TEST(RayLight, IsForStills) {
    Scene scene = floor_and_wall(1, diffuse(0));
    scene.set_environment(constant_environment(1));
    app::Session session = wall_session(scene, 1);
    Settings& s = session.settings();
    const auto differs = [&](int samples) {
        s.rays.enabled = automatic;
        const Image automatic = render_linear(session, samples);
        s.rays.enabled = false;
        return largest_difference(automatic, render_linear(session, samples)) > 0;
    };
    EXPECT_FALSE(differs(1));
    EXPECT_FALSE(differs(16));
    EXPECT_TRUE(differs(32));
    s.ssao.enabled = false;
    EXPECT_FALSE(differs(32));
    s.rays.count = 0;
    EXPECT_THROW(render_linear(session, 1), ArgumentError);
}

// A scene without content has nothing to trace.
TEST(RayLight, NothingIsNoError) {
    Scene scene;
    scene.set_environment(constant_environment(1));
    app::Session session = sky_session(scene, 16, 1);
    session.settings().rays.enabled = true;
    session.settings().camera.near = 0.01;
    const Image picture = render_linear(session, 2);
    for (const float v : picture.pixels<float>()) EXPECT_EQ(v, 0);
}

}  // namespace
}  // namespace easypbr::ray_light_test
