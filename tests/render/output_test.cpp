#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/image.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::output_test {
namespace {

/// An unlit square that fills the picture.
Mesh unlit(const Vec3& linear) {
    Material m;
    m.base_color = Vec3::Zero();
    m.emissive = linear;
    m.roughness = 1;
    return facing_square(100, m);
}

/// Display light of an input through a tone curve, from a 16-bit picture.
Vec3 tone_mapped(ToneOperator tone_operator, const Vec3& linear, int samples = 1) {
    Scene scene;
    scene.show(unlit(linear), "square");
    app::Session session = plain_session(scene, 8);
    session.settings().tonemap.tone_operator = tone_operator;
    look_from(session, Vec3d(0, 0, 7));
    const Image image = session.render({std::nullopt, samples, app::Encoding::srgb16});
    Vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = linear_from_srgb(float(image.at<uint16_t>(4, 4)[c]) / 65535.0f);
    return out;
}

// Reference outputs of the published formulas. 0.002 is the required bound.
TEST(ToneCurve, MatchesReferenceValues) {
    struct Case {
        ToneOperator tone_operator;
        Vec3 in, out;
    };
    const auto grey = [](float v) { return Vec3(v, v, v); };
    const Vec3 red(1, 0, 0), orange(4, 0.5f, 0.1f);
    const Case cases[] = {{ToneOperator::aces, grey(0.18f), grey(0.1056f)},
                          {ToneOperator::aces, grey(1), grey(0.6191f)},
                          {ToneOperator::aces, grey(4), grey(0.9090f)},
                          {ToneOperator::aces, red, Vec3(0.688f, 0, 0.0026f)},
                          {ToneOperator::aces, orange, Vec3(1, 0.494f, 0.154f)},
                          {ToneOperator::reinhard, grey(0.18f), grey(0.1525f)},
                          {ToneOperator::reinhard, grey(1), grey(0.5f)},
                          {ToneOperator::reinhard, red, Vec3(0.825f, 0, 0)},
                          {ToneOperator::reinhard, orange, Vec3(1, 0.226f, 0.045f)},
                          {ToneOperator::neutral, grey(0.18f), grey(0.14f)},
                          {ToneOperator::neutral, grey(1), grey(0.8691f)},
                          {ToneOperator::neutral, grey(4), grey(0.9833f)},
                          {ToneOperator::neutral, red, Vec3(0.880f, 0.0156f, 0.0156f)},
                          {ToneOperator::neutral, orange, Vec3(0.983f, 0.382f, 0.314f)},
                          {ToneOperator::agx, grey(0.18f), grey(0.2145f)},
                          {ToneOperator::agx, grey(1), grey(0.590f)},
                          {ToneOperator::agx, grey(4), grey(0.861f)},
                          {ToneOperator::agx, red, Vec3(0.719f, 0.039f, 0.040f)},
                          {ToneOperator::agx, orange, Vec3(0.949f, 0.477f, 0.275f)},
                          {ToneOperator::none, grey(0.18f), grey(0.18f)},
                          {ToneOperator::none, orange, Vec3(1, 0.5f, 0.1f)}};
    for (const Case& c : cases)
        for (const int samples : {1, 4})
            EXPECT_LT((tone_mapped(c.tone_operator, c.in, samples) - c.out).cwiseAbs().maxCoeff(), 0.002f)
                << "operator " << int(c.tone_operator) << " in " << c.in.transpose() << " samples "
                << samples;
}

// sRGB encoding by the exact curve: the nearest code.
TEST(Output, ExactTransferCurve) {
    for (const float v : {0.0f, 0.001f, 0.0031308f, 0.18f, 0.5f, 1.0f}) {
        Scene scene;
        scene.show(unlit(Vec3::Constant(v)), "square");
        app::Session session = plain_session(scene, 8);
        look_from(session, Vec3d(0, 0, 7));
        EXPECT_NEAR(session.render().at<uint8_t>(4, 4)[0], srgb_from_linear(v) * 255, 0.51) << v;
    }
}

TEST(Output, BackgroundColorIsExact) {
    Scene scene;
    scene.show(make_sphere(), "sphere");
    for (const int samples : {1, 4}) {
        app::Session session = plain_session(scene);
        session.settings().background.mode = BackgroundMode::color;
        session.settings().background.color = Vec3(0x20, 0x40, 0x60) / 255.0f;
        session.settings().tonemap.tone_operator = ToneOperator::aces;
        session.settings().image.samples = samples;
        const Image image = session.render();
        for (const auto& [x, y] : {std::pair(0, 0), std::pair(63, 63), std::pair(4, 4)}) {
            const uint8_t* p = image.at<uint8_t>(x, y);
            EXPECT_EQ(std::vector<int>(p, p + 4), (std::vector<int>{0x20, 0x40, 0x60, 255}));
        }
    }
}

TEST(Output, TransparentBackground) {
    Scene scene;
    scene.show(make_sphere(), "sphere");
    app::Session session = plain_session(scene);
    session.settings().image.samples = 16;
    const Image image = session.render();
    EXPECT_EQ(image.at<uint8_t>(0, 0)[3], 0);
    EXPECT_EQ(image.at<uint8_t>(32, 32)[3], 255);
    // Edges are covered in part.
    size_t partly = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const int a = image.pixels<uint8_t>()[4 * i + 3];
        partly += a > 0 && a < 255;
    }
    EXPECT_GT(partly, 50u);
}

// The environment behind the object is the environment: a constant one is constant everywhere.
TEST(Output, EnvironmentAsBackground) {
    Scene scene;
    scene.show(make_sphere(), "sphere");
    scene.set_environment(constant_environment(0.25f));
    for (const BackgroundMode mode : {BackgroundMode::environment, BackgroundMode::blur})
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            app::Session session = plain_session(scene);
            session.settings().environment.enabled = true;
            session.settings().background.mode = mode;
            session.settings().camera.projection = projection;
            const Image image = render_linear(session);
            EXPECT_NEAR(image.at<float>(0, 0)[0], 0.25f, 1e-4);
            EXPECT_EQ(image.at<float>(0, 0)[3], 1.0f);
        }
}

// Six coloured axes: what stands where in the picture of an equirectangular map.
TEST(Output, EnvironmentIsTheRightWayRound) {
    Image map(64, 32, 3, PixelType::f32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec3 d = equirect_direction((float(x) + 0.5f) / 64, (float(y) + 0.5f) / 32);
            const Vec3 value = (d.array() + 1) / 2;
            std::copy_n(value.data(), 3, map.at<float>(x, y));
        }
    Scene scene;
    scene.show(make_sphere(0.001f, 8), "sphere");
    scene.set_environment(Environment(map));
    app::Session session = plain_session(scene);
    session.settings().environment.enabled = true;
    session.settings().background.mode = BackgroundMode::environment;
    for (const Vec3d& forward :
         {Vec3d(0, 0, -1), Vec3d(1, 0, 0), Vec3d(0, 0, 1), Vec3d(-1, 0, 0), Vec3d(0.6, 0.8, 0)}) {
        session.set_camera(Camera::look_at(-forward, Vec3d(0, 0, 0)));
        const Image image = render_linear(session);
        // Next to the tiny sphere in the middle; a pixel is 0.5 degrees, a texel 5.6: bilinear, about 0.02.
        const float* p = image.at<float>(34, 32);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c], (forward[c] + 1) / 2, 0.03) << forward.transpose();
    }
}

// Accumulation is the mean over jittered frames: an edge through a pixel's centre covers half of it.
TEST(Output, AccumulationIsABoxFilter) {
    Scene scene;
    Array3f::Dense V(4, 3);
    V << 0, -100, 0, 100, -100, 0, 100, 100, 0, 0, 100, 0;
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    scene.show(Mesh(Array3f(V), Array3i(F)), "half");
    app::Session session = plain_session(scene, 65);  // odd: the edge runs through the centres of column 32
    session.settings().image.samples = 64;
    look_from(session, Vec3d(0, 0, 7));
    const Image image = session.render();
    EXPECT_EQ(image.at<uint8_t>(31, 32)[3], 0);
    EXPECT_EQ(image.at<uint8_t>(33, 32)[3], 255);
    // 64 Halton points: within two of 32.
    EXPECT_NEAR(image.at<uint8_t>(32, 32)[3] / 255.0, 0.5, 2.0 / 64 + 0.002);
}

TEST(Output, SameTwice) {
    Scene scene;
    scene.show(make_teapot(1, 6), "teapot");
    app::Session a(scene), b(scene);
    for (app::Session* session : {&a, &b}) {
        session->settings().image.size = Vec2i(120, 90);
        session->settings().image.samples = 4;
    }
    EXPECT_EQ(compare(a.render(), b.render()).different, 0u);
    EXPECT_EQ(compare(a.render(), b.render()).different, 0u);
}

// FXAA turns the staircase of an edge into grey steps and leaves the inside alone.
TEST(Output, FxaaSmoothsEdgesOnly) {
    Scene scene;
    scene.show(make_sphere(), "sphere");
    app::Session session = plain_session(scene, 128);
    session.settings().environment.enabled = true;
    session.settings().background.mode = BackgroundMode::color;
    session.settings().background.color = Vec3::Zero();
    const Image sharp = session.render();
    session.settings().image.antialias = Antialias::fxaa;
    const Image smooth = session.render();
    const ImageDifference difference = compare(sharp, smooth);
    EXPECT_GT(difference.different, 100u);
    EXPECT_LT(difference.different, 1500u);  // the outline has about 360 pixels, touched two or three deep
    const uint8_t *p = sharp.at<uint8_t>(64, 64), *q = smooth.at<uint8_t>(64, 64);
    EXPECT_EQ(std::vector<int>(p, p + 4), std::vector<int>(q, q + 4));
}

// FXAA before a transparent background: the outline is covered in part, in the object's own colour.
TEST(Output, FxaaSmoothsTransparentEdges) {
    for (const bool native : {true, false})
        for (const int code : {255, 0}) {
            Material material;
            material.base_color = Vec3::Zero();
            material.emissive = Vec3::Constant(float(code) / 255);
            Mesh sphere = make_sphere();
            sphere.set_material(material);
            Scene scene;
            scene.show(sphere, "sphere");
            app::Session session = plain_session(scene);
            session.allow_native_shading(native);
            session.settings().image.antialias = Antialias::fxaa;
            const Image image = session.render();
            size_t partly = 0, off = 0;
            for (int i = 0; i < int(image.pixel_count()); ++i) {
                const uint8_t* p = &image.pixels<uint8_t>()[size_t(i) * 4];
                partly += p[3] > 0 && p[3] < 255;
                off += p[3] > 0 && (p[0] != code || p[1] != code || p[2] != code);
            }
            EXPECT_GT(partly, 50u) << code << ", native " << native;  // the outline has about 180 pixels
            EXPECT_EQ(off, 0u) << code << ", native " << native;
        }
}

/// Three lines that cross each other, before a square that fills the picture.
Scene crossing_lines(bool with_lines) {
    Scene scene;
    scene.show(unlit(Vec3::Constant(0.5f)), "square");
    if (!with_lines) return scene;
    Array3f::Dense V(6, 3);
    V << -1, 0.05f, 0.5f, 1, 0.05f, 0.5f, 0.05f, -1, 0.5f, 0.05f, 1, 0.5f, -1, -0.6f, 0.5f, 1, 0.8f, 0.5f;
    Array2i::Dense E(3, 2);
    E << 0, 1, 2, 3, 4, 5;
    MeshData lines;
    lines.V = Array3f(V);
    lines.E = Array2i(E);
    scene.show(Mesh(lines), "lines");
    return scene;
}

// Lines are drawn smooth: FXAA changes no pixel that one covers a part of.
TEST(Output, FxaaLeavesLinesAsTheyAre) {
    for (const bool native : {true, false}) {
        const auto drawn = [&](bool with_lines, Antialias antialias) {
            app::Session session = plain_session(crossing_lines(with_lines));
            session.allow_native_shading(native);
            session.settings().image.antialias = antialias;
            look_from(session, Vec3d(0, 0, 4));
            return session.render();
        };
        const Image without = drawn(false, Antialias::none), sharp = drawn(true, Antialias::none),
                    smooth = drawn(true, Antialias::fxaa);
        size_t covered = 0, changed = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const int own = sharp.at<uint8_t>(x, y)[0];
                if (own == without.at<uint8_t>(x, y)[0]) continue;
                ++covered;
                changed += own != smooth.at<uint8_t>(x, y)[0];
            }
        EXPECT_GT(covered, 300u) << "native " << native;  // three lines of 55 to 64 pixels, 1.5 wide
        EXPECT_EQ(changed, 0u) << "native " << native;
    }
}

TEST(Output, RefusesSizesThatCannotBe) {
    Scene scene;
    scene.show(make_sphere(), "sphere");
    app::Session session(scene);
    EXPECT_THROW(session.render({Vec2i(0, 10), 1}), ArgumentError);
    EXPECT_THROW(session.render({Vec2i(10, -1), 1}), ArgumentError);
    EXPECT_THROW(session.render({Vec2i(100000, 10), 1}), ArgumentError);
    // Pictures are drawn in tiles, ground truth is one frame.
    EXPECT_EQ(session.render({Vec2i(40000, 10), 1}).width(), 40000);
    session.allow_native_geometry(false);  // which has no limit
    EXPECT_THROW(session.draw_surfaces({Vec2i(40000, 10), 1}, false), ContextError);
    EXPECT_THROW(session.render({Vec2i(10, 10), 0}), ArgumentError);
    EXPECT_EQ(session.render({Vec2i(10, 10), 1}).width(), 10);
}

}  // namespace
}  // namespace easypbr::output_test
