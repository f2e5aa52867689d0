// Depth of field against the thin lens: circles of confusion, what stays sharp, what must not be touched.
#include <cmath>
#include <cstring>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/scene/resolve.h"
#include "render_test.h"

namespace easypbr::depth_of_field_test {
namespace {

constexpr int size = 241;
constexpr double focus = 10, sensor = 0.5, f_number = 1;

/// A white square of this half width at a distance before the camera, which is at the origin and looks along
/// -z.
Scene lamp_at(double distance, float half) {
    Material white;
    white.emissive = Vec3::Constant(1);
    white.base_color = Vec3::Zero();
    Scene scene;
    Mesh mesh = facing_square(half, white);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -distance)));
    scene.show(mesh, "lamp");
    return scene;
}

app::Session lens_session(const Scene& scene) {
    app::Session session = plain_session(scene, size);
    CameraSettings& camera = session.settings().camera;
    camera.position = Vec3d(0, 0, 0);
    camera.target = Vec3d(0, 0, -1);
    camera.near = 0.01;
    DepthOfFieldSettings& lens = session.settings().depth_of_field;
    lens.enabled = true;
    lens.f_number = float(f_number);
    lens.sensor_height = sensor;
    lens.focus_distance = focus;
    return session;
}

/// Diameter of the aperture times |z - zf| / z times magnification f / (zf - f), half of it, in pixels.
double formula(double z) {
    const double v = sensor / (2 * std::tan(radians(15.0))), f = v * focus / (v + focus);
    return f / f_number * f * std::abs(z - focus) / (z * (focus - f)) / 2 * size / sensor;
}

/// Light of the picture as a distribution over it.
struct Spot {
    Vec2d centre{0, 0};
    double variance = 0;  ///< mean of both axes
    double sum = 0;
};

Spot spot_of(const Image& picture) {
    Spot spot;
    Vec2d square(0, 0);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const double light = picture.at<float>(x, y)[1];
            const Vec2d p(x + 0.5, y + 0.5);
            spot.sum += light;
            spot.centre += light * p;
            square += light * p.cwiseProduct(p);
        }
    spot.centre /= spot.sum;
    spot.variance = (square / spot.sum - spot.centre.cwiseProduct(spot.centre)).mean();
    return spot;
}

// The variance of a disc of radius r is r^2 / 4 along each axis, that of a square of side s is s^2 / 12;
// blurred by each other they add up. The picture's samples are 256 places on the lens, or one frame's
// gathering.
TEST(DepthOfField, CirclesOfConfusionAreThoseOfTheThinLens) {
    for (double z : {4.0, 5.5, 7.0, 16.0, 30.0, 100.0}) {
        const float half = float(0.012 * z);  // 5.4 pixels wide at every distance
        const double side = 2 * half / z * size / (2 * std::tan(radians(15.0)));
        app::Session session = lens_session(lamp_at(z, half));
        for (int samples : {256, 1}) {
            // Single frames blur up to a sixteenth of the picture's height.
            const double expected = samples == 1 ? std::min(formula(z), size / 16.0) : formula(z);
            const Spot spot = spot_of(render_linear(session, samples));
            const double radius = 2 * std::sqrt(std::max(spot.variance - side * side / 12, 0.0));
            EXPECT_NEAR(radius, expected, 1) << "z " << z << ", samples " << samples;
            // The lens passes all light on, and its middle is where the pinhole was.
            EXPECT_LT((spot.centre - Vec2d(size, size) / 2).norm(), 0.5) << z << " " << samples;
            EXPECT_NEAR(spot.sum, side * side, (samples == 1 ? 0.25 : 0.05) * side * side) << z;
        }
    }
}

TEST(DepthOfField, WhatIsInFocusStaysSharp) {
    app::Session session = lens_session(lamp_at(focus, 1));
    for (int samples : {1, 16}) {
        session.settings().depth_of_field.enabled = true;
        const Image with = render_linear(session, samples);
        session.settings().depth_of_field.enabled = false;
        const Image without = render_linear(session, samples);
        // Samples on an edge may fall to its other side by rounding: one of sixteen in a pixel. In single
        // frames what is blurred has half the resolution: a texel on the edge holds up to half of the light
        // within it, and a pixel beside the edge takes three quarters of it.
        const float tolerance = samples == 1 ? 0.376f : 0.07f;
        for (size_t i = 0; i < with.pixel_count(); ++i) {
            const float sharp = without.pixels<float>()[4 * i + 1], seen = with.pixels<float>()[4 * i + 1];
            ASSERT_NEAR(seen, sharp, sharp == 1 ? 0.01f : tolerance) << i << " " << samples;
        }
    }
}

// A near square covers what is behind it by as much as the lens sees past it: half at its edge.
TEST(DepthOfField, WhatIsNearIsSeenThroughAtItsEdge) {
    Material white;
    white.emissive = Vec3::Constant(1);
    Material black;
    black.base_color = Vec3::Zero();
    black.unlit = true;
    Scene scene;
    Mesh wall = facing_square(6, white), before = facing_square(1, black);
    wall.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -focus)));
    before.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-1, 0, -5)));
    scene.show(wall, "wall");
    scene.show(before, "before");
    app::Session session = lens_session(scene);
    const int middle = size / 2;
    for (int samples : {256, 1}) {
        const Image picture = render_linear(session, samples);
        EXPECT_NEAR(picture.at<float>(middle, middle)[1], 0.5f, 0.08f) << samples;
        const int beyond = int(formula(5)) + 3;
        EXPECT_NEAR(picture.at<float>(middle + beyond, middle)[1], 1, 0.02f) << samples;
        EXPECT_NEAR(picture.at<float>(middle - beyond, middle)[1], 0, 0.02f) << samples;
    }
}

/// A square of this colour, which is shown as it is, this far before the camera.
Mesh square_as_it_is(double distance, float half, const Vec3& color) {
    Material plain;
    plain.base_color = color;
    Mesh mesh = facing_square(half, plain);
    mesh.edit([](MeshData& d) { d.style.lit = false; });
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -distance)));
    return mesh;
}

// Nothing else is in the picture, so the lens changes none of its bytes.
TEST(DepthOfField, ColorsThatAreShownAsTheyAreStaySharp) {
    for (const DrawMode mode : {DrawMode::mesh, DrawMode::points, DrawMode::surfels, DrawMode::voxels})
        for (const bool labels : {false, true}) {
            Mesh mesh = make_sphere(0.8, 24);
            mesh.edit([&](MeshData& d) {
                Array1i::Dense L(d.V.rows());
                L.setConstant(3);
                d.L = Array1i(L);
                d.style.mode = mode;
                d.style.lit = false;
                if (labels) d.style.color_by = ColorBy::label;
            });
            mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -4)));
            Scene scene;
            scene.show(mesh, "ball");
            app::Session session = lens_session(scene);
            for (const bool native : {true, false}) {
                session.allow_native_shading(native);
                session.settings().depth_of_field.enabled = false;
                const Image without = session.render({std::nullopt, 1, app::Encoding::srgb8});
                session.settings().depth_of_field.enabled = true;
                const Image with = session.render({std::nullopt, 1, app::Encoding::srgb8});
                EXPECT_EQ(std::memcmp(with.bytes().data(), without.bytes().data(), with.bytes().size()), 0)
                    << "mode " << int(mode) << ", labels " << labels << ", native " << native;
            }
        }
}

// Before a white wall that is out of focus, behind it or before it, whatever the lens mixes is white: what
// has no light of its own darkens none of it, and hides it where it is seen itself. What is gathered is kept
// in halves, which err by 0.0005 where it is 1; three of them make a pixel.
TEST(DepthOfField, ColorsThatAreShownAsTheyAreDarkenNothing) {
    for (const double wall : {30.0, 10.6, 9.3, 6.0}) {
        Scene scene = lamp_at(wall, float(wall));
        scene.show(square_as_it_is(5, 0.3f, Vec3::Zero()), "before");
        app::Session session = lens_session(scene);
        session.settings().edl.enabled = false;
        for (const bool native : {true, false}) {
            session.allow_native_shading(native);
            session.settings().depth_of_field.enabled = false;
            const Image without = render_linear(session);
            session.settings().depth_of_field.enabled = true;
            const Image with = render_linear(session);
            int dark = 0;
            for (size_t i = 0; i < with.pixel_count(); ++i) {
                const float sharp = without.pixels<float>()[4 * i + 1];
                ASSERT_NEAR(with.pixels<float>()[4 * i + 1], sharp, 0.002f)
                    << i << ", wall " << wall << ", native " << native;
                dark += sharp < 0.5f;
            }
            // 0.6 across at a distance of 5, of a picture 2 * 5 * tan(15 degrees) high: 54 pixels squared.
            EXPECT_NEAR(dark, 54 * 54, 2 * 54);
        }
    }
}

TEST(DepthOfField, LayersAreThoseOfThePinhole) {
    app::Session session = lens_session(lamp_at(4, 1));
    const std::vector<std::string> names = {"depth", "object_id", "normal_world", "albedo"};
    session.settings().depth_of_field.enabled = false;
    const auto without = session.render_layers(names);
    session.settings().depth_of_field.enabled = true;
    const auto with = session.render_layers(names);
    for (const std::string& name : names)
        EXPECT_EQ(std::memcmp(with.at(name).bytes().data(), without.at(name).bytes().data(),
                              with.at(name).bytes().size()),
                  0)
            << name;
}

TEST(DepthOfField, OrthographicCamerasHaveNoLensAndSaySo) {
    app::Session session = lens_session(lamp_at(4, 1));
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 4.0;
    std::string logged;
    set_log_sink([&](LogLevel, std::string_view text) { logged += text; });
    const Image with = render_linear(session, 4);
    set_log_sink({});
    EXPECT_NE(logged.find("orthographic"), std::string::npos);
    session.settings().depth_of_field.enabled = false;
    const Image without = render_linear(session, 4);
    EXPECT_EQ(std::memcmp(with.bytes().data(), without.bytes().data(), with.bytes().size()), 0);
}

TEST(DepthOfField, FocusesOnAPixel) {
    app::Session session = lens_session(lamp_at(4, 1));
    EXPECT_NEAR(session.focus_at(size / 2, size / 2), 4, 1e-5);
    EXPECT_NEAR(*session.settings().depth_of_field.focus_distance, 4, 1e-5);
    EXPECT_THROW(session.focus_at(1, 1), ArgumentError);
    EXPECT_THROW(session.focus_at(size, 0), ArgumentError);
    EXPECT_THROW(session.focus_at(-1, 0), ArgumentError);
    EXPECT_NEAR(*session.settings().depth_of_field.focus_distance, 4, 1e-5);
}

TEST(DepthOfField, FocusesOnTheMiddleOfTheContentByItself) {
    app::Session session = lens_session(lamp_at(7, 1));
    session.settings().depth_of_field.focus_distance = automatic;
    EXPECT_NEAR(session.resolve().settings.depth_of_field.focus_distance, 7, 1e-6);
    session.settings().camera.position = Vec3d(0, 0, 3);
    EXPECT_NEAR(session.resolve().settings.depth_of_field.focus_distance, 10, 1e-6);
}

TEST(DepthOfField, TheWorldsUnitMakesNoDifference) {
    std::vector<double> radii;
    for (double scale : {0.001, 1.0, 1000.0}) {
        app::Session session = lens_session(lamp_at(4 * scale, float(scale)));
        session.settings().camera.near = automatic;
        session.settings().depth_of_field.focus_distance = 10 * scale;
        session.settings().depth_of_field.sensor_height = automatic;
        radii.push_back(session.resolve().lens_radius / scale);
    }
    EXPECT_NEAR(radii[0], radii[1], 1e-6 * radii[1]);
    EXPECT_NEAR(radii[2], radii[1], 1e-6 * radii[1]);
}

// A white room stays white: whatever the lens mixes is white.
TEST(DepthOfField, HoldsTheFurnace) {
    Material white;
    white.base_color = Vec3::Ones();
    white.roughness = 0.5f;
    Mesh ball = make_sphere(1, 48);
    ball.set_material(white);
    Scene scene;
    scene.show(ball, "ball");
    scene.set_environment(constant_environment(0.5f));
    app::Session session = plain_session(scene, 97);
    session.settings().environment.enabled = true;
    session.settings().background.mode = BackgroundMode::environment;
    session.settings().depth_of_field.enabled = true;
    session.settings().depth_of_field.f_number = 0.5f;
    for (int samples : {1, 16}) {
        const Image picture = render_linear(session, samples);
        for (size_t i = 0; i < picture.pixel_count(); ++i)
            ASSERT_NEAR(picture.pixels<float>()[4 * i + 1], 0.5f, 0.01f) << i << " " << samples;
    }
}

}  // namespace
}  // namespace easypbr::depth_of_field_test
