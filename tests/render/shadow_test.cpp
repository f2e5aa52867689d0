// Shadows whose every pixel is known.
#include "shadow_test.h"

#include <set>

#include "easypbr/core/error.h"
#include "easypbr/render/frame/shadow_view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::shadow_test {
namespace {

// The map has a texel per 2 / (64 - 6) over the square of -1 .. 1 (3 texels are its margin). The caster's
// edges lie between texels. An orthographic camera that looks at 60 degrees from the normal sees the floor
// through the middles of texels, every one in x and every second in y. There the mean of 3x3 is that of k
// whole texels.
TEST(Shadow, ThreeByThreeCountsNinths) {
    constexpr float texel = 2.0f / 58;
    Scene scene;
    scene.show(rectangle(-1, -1, 1, 1, 0), "floor");
    scene.show(rectangle(-0.1f, -0.1f, 0.1f, 0.1f, -0.2f),
               "below");  // so that the map shows all of the floor
    scene.show(rectangle(-10 * texel, -8 * texel, 12 * texel, 6 * texel, 0.5f), "caster");
    scene.set_light("sun", directional(Vec3(0, 0, -1)));
    app::Session session = shadow_session(scene, ShadowMode::pcf);
    Settings& s = session.settings();
    s.shadows.resolution = 64;
    s.camera.projection = Projection::orthographic;
    s.camera.ortho_height = 64.0 * texel;
    s.camera.target = Vec3d(0, texel / 2, 0);
    s.camera.position = Vec3d(0, texel / 2 - 4 * std::sin(radians(60)), 4 * std::cos(radians(60)));
    const LitParts lit = lit_parts(session);
    std::set<int> ninths;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec3d p = lit.position(x, y);
            if (lit.at(x, y) < 0 || std::abs(p.z()) > 1e-4) continue;
            const double column = p.x() / texel, row = p.y() / texel;
            ASSERT_NEAR(column - std::floor(column), 0.5, 1e-3);
            ASSERT_NEAR(row - std::floor(row), 0.5, 1e-3);
            int blocked = 0;
            for (const int i : {-1, 0, 1})
                for (const int j : {-1, 0, 1})
                    blocked += column + i > -10 && column + i < 12 && row + j > -8 && row + j < 6;
            // Positions in single precision move the texels' weights by less than a thousandth.
            EXPECT_NEAR(lit.at(x, y), (9 - blocked) / 9.0, 2e-3) << x << ", " << y;
            ninths.insert(blocked);
        }
    EXPECT_EQ(ninths, (std::set<int>{0, 1, 2, 3, 4, 6, 9}));
}

/// Every kind of map under a light that falls on the plane z = 0 at an angle.
std::vector<std::pair<const char*, Light>> lights_at(double angle_deg, double scale) {
    const double a = radians(angle_deg), around = radians(25);
    const Vec3d towards(std::sin(a) * std::cos(around), std::sin(a) * std::sin(around), std::cos(a));
    Light spot = point((6 * scale * towards).cast<float>(), float(0.2 * scale));
    spot.type = LightType::spot;
    spot.direction = -towards.cast<float>();
    spot.outer_cone_deg = 40;
    return {{"directional", directional(-towards.cast<float>(), 2)},
            {"point", point((6 * scale * towards).cast<float>(), float(0.2 * scale))},
            {"spot", spot}};
}

constexpr ShadowMode modes[] = {ShadowMode::hard, ShadowMode::pcf, ShadowMode::soft};

// A plane does not shadow itself, at whatever angle the light falls and at whatever scale.
TEST(Shadow, NoAcneOnAPlane) {
    for (const double scale : {0.001, 1.0, 1000.0}) {
        const float s = float(scale);
        Scene scene;
        scene.show(rectangle(-s, -s, s, s, 0), "plane");
        for (const ShadowMode mode : modes) {
            app::Session session = shadow_session(scene, mode);
            look_from(session, Vec3d(0.3, -1, 4) * scale);
            for (int angle = 0; angle <= 80; angle += 10)
                for (const auto& [name, light] : lights_at(angle, scale)) {
                    session.scene().set_light("light", light);
                    const LitParts lit = lit_parts(session);
                    float least = 1;
                    for (const float part : lit.parts.pixels<float>())
                        if (part >= 0) least = std::min(least, part);
                    // Not one texel of any filter may be taken for a caster: 1 / 16 at least would be
                    // missing.
                    EXPECT_GT(least, 0.999f)
                        << name << " at " << angle << " degrees, scale " << scale << ", mode " << int(mode);
                }
        }
    }
}

// The same in a cube: a light between two planes, up to 80 degrees from the normal.
TEST(Shadow, NoAcneAroundALightInside) {
    for (const double scale : {0.001, 1.0, 1000.0}) {
        const float s = float(scale);
        Scene scene;
        scene.show(rectangle(-3 * s, -3 * s, 3 * s, 3 * s, 0), "floor");
        scene.show(rectangle(-3 * s, -3 * s, 3 * s, 3 * s, 2 * s), "ceiling");
        const Vec3 position(0.1f * s, 0.2f * s, 0.6f * s);
        scene.set_light("light", point(position, 0.05f * s));
        for (const ShadowMode mode : modes) {
            app::Session session = shadow_session(scene, mode, 128);
            look_from(session, Vec3d(0, -2.9, 1.8) * scale, 90);
            const LitParts lit = lit_parts(session);
            float least = 1;
            for (int y = 0; y < 128; ++y)
                for (int x = 0; x < 128; ++x) {
                    const Vec3d p = lit.position(x, y), to_light = position.cast<double>() - p;
                    const bool seen =
                        lit.at(x, y) >= 0 && std::abs(to_light.z()) > std::cos(radians(80)) * to_light.norm();
                    if (seen) least = std::min(least, lit.at(x, y));
                }
            EXPECT_GT(least, 0.999f) << "scale " << scale << ", mode " << int(mode);
        }
    }
}

// A box stands on a floor. Its shadow begins within 2 texels of it, at any scale.
TEST(Shadow, TouchesItsCaster) {
    for (const double scale : {0.001, 1.0, 1000.0})
        for (const double angle : {30.0, 45.0, 60.0, 75.0})
            for (const ShadowMode mode : modes) {
                const float s = float(scale);
                Scene scene;
                scene.show(rectangle(-2 * s, -2 * s, 2 * s, 2 * s, 0), "floor");
                Mesh box = make_box(Vec3(s, s, s));
                box.set_material(matt());
                box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.5 * scale)));
                scene.show(box, "box");
                const Light sun = directional(
                    Vec3(float(std::sin(radians(angle))), 0, -float(std::cos(radians(angle)))), 1);
                scene.set_light("sun", sun);
                app::Session session = shadow_session(scene, mode, 256);
                session.settings().shadows.resolution = 256;
                look_from(session, Vec3d(2, 0, 2) * scale, 15);
                session.settings().camera.target = Vec3d(0.6 * scale, 0, 0);
                const auto view =
                    render::project_shadows(ResolvedLight(sun, 0), scene.snapshot().bounds(), 256)->views[0];
                const double texel = 1 / (view.scale.minCoeff() * 256);
                const LitParts lit = lit_parts(session);
                int near = 0;
                for (int y = 0; y < 256; ++y)
                    for (int x = 0; x < 256; ++x) {
                        const Vec3d p = lit.position(x, y);
                        const double gap = p.x() - 0.5 * scale;
                        if (lit.at(x, y) < 0 || std::abs(p.z()) > 1e-3 * scale ||
                            std::abs(p.y()) > 0.3 * scale)
                            continue;
                        if (gap < 2 * texel || gap > 0.25 * scale) continue;
                        near += gap < 4 * texel;
                        EXPECT_LT(lit.at(x, y), 0.5f)
                            << "gap of " << gap / texel << " texels at " << angle << " degrees, scale "
                            << scale << ", mode " << int(mode);
                    }
                EXPECT_GT(near, 30);
            }
}

/// Part of a disc of radius 1 on one side of a line at distance s from its centre.
double disc_part(double s) {
    s = std::clamp(s, -1.0, 1.0);
    return 0.5 + (s * std::sqrt(1 - s * s) + std::asin(s)) / pi;
}

/// Where the light that passes a knife edge falls from 90 to 10 percent: means of columns, interpolated.
double penumbra_width(const LitParts& lit, int size) {
    std::vector<double> position, part;
    for (int x = 0; x < size; ++x) {
        double sum = 0, where = 0;
        int count = 0;
        for (int y = size / 4; y < size * 3 / 4; ++y) {
            const Vec3d p = lit.position(x, y);
            if (lit.at(x, y) < 0 || std::abs(p.z()) > 1e-3) continue;
            sum += lit.at(x, y);
            where += p.x();
            ++count;
        }
        if (count < size / 8) continue;
        position.push_back(where / count);
        part.push_back(sum / count);
    }
    const auto crossing = [&](double level) {
        for (size_t i = 1; i < part.size(); ++i)
            if (part[i - 1] >= level && part[i] < level)
                return position[i - 1] +
                       (position[i] - position[i - 1]) * (part[i - 1] - level) / (part[i - 1] - part[i]);
        return std::nan("");
    };
    return crossing(0.1) - crossing(0.9);
}

// A disc of radius r at height H over a knife edge at height h gives a penumbra of half width r h / (H - h)
// below; it falls from 90 to 10 percent over the middle 2 * 0.6870 of it, where disc_part() is 0.9
// (techniques: similar triangles).
TEST(Shadow, PenumbraOfAKnifeEdge) {
    constexpr double H = 6;
    ASSERT_NEAR(disc_part(0.6870), 0.9, 1e-4);
    for (const double radius : {0.15, 0.4})
        for (const double h : {0.5, 1.0, 2.0})
            for (const int samples : {1, 64}) {
                Scene scene;
                scene.show(rectangle(-2, -2, 2, 2, 0), "floor");
                scene.show(rectangle(0, -2, 3, 2, float(h)), "edge");
                scene.set_light("lamp", point(Vec3(0, 0, float(H)), float(radius)));
                app::Session session = shadow_session(scene, ShadowMode::soft, 128);
                const double half = radius * h / (H - h), expected = 2 * 0.6870 * half;
                // From the side, below the caster, so narrow that the penumbra fills most of the picture.
                look_from(session, Vec3d(0, -2, 0.6 * h));
                session.settings().camera.projection = Projection::orthographic;
                session.settings().camera.ortho_height = 3 * half;
                const double width = penumbra_width(lit_parts(session, samples), 128);
                EXPECT_NEAR(width / expected, 1, 0.1)
                    << "radius " << radius << ", h " << h << ", samples " << samples;
            }
}

// A closed box stands on a ground that a lamp lights from within the scene: along the box's foot, where the
// lamp is hidden, no light is left, whichever face of the lamp's cube sees it.
TEST(Shadow, OfAClosedBoxReachesItsFootInEachFaceOfACube) {
    for (const char* up : {"+x", "-x", "+y", "-y", "+z", "-z"})
        for (const bool native : {true, false}) {
            const Vec3d axis = parse_up(up);
            const Mat3d R = Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitY(), axis).toRotationMatrix();
            const auto placed = [&](const Vec3d& p) { return Vec3d(R * p); };
            Scene scene;
            Mesh box = make_box(Vec3::Constant(0.8f));
            box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(placed(Vec3d(1.2, 0.4, -0.3)))));
            scene.show(box, "box");
            scene.set_light("lamp", point(placed(Vec3d(0.5, 2, 1)).cast<float>(), 0.05f));
            for (const ShadowMode mode : modes) {
                app::Session session = shadow_session(scene, mode, 32);
                session.allow_native_geometry(native);
                Settings& s = session.settings();
                s.shadows.enabled = true;
                s.ground.mode = GroundMode::plane;
                s.ground.height = 0.0;
                s.camera.up = up;
                s.camera.projection = Projection::orthographic;
                s.camera.ortho_height = 0.05;
                s.camera.target = placed(Vec3d(1.63, 0, -0.4));
                s.camera.position = placed(Vec3d(1.63, 3, -0.399));
                const Image picture = render_linear(session);
                float most = 0;
                for (int y = 0; y < 32; ++y)
                    for (int x = 0; x < 32; ++x) most = std::max(most, picture.at<float>(x, y)[0]);
                EXPECT_EQ(most, 0) << up << ", mode " << int(mode) << ", " << native;
            }
        }
}

// A lamp 2 above a floor of half size 50, whose automatic radius would be 3.5: nothing hides any of it.
// 0.001: as NoAcneOnAPlane.
TEST(Shadow, AutomaticEmittersLightTheFloorBelowThem) {
    Scene scene;
    scene.show(rectangle(-50, -50, 50, 50, 0), "floor");
    Light lamp = point(Vec3(0, 0, 2));
    lamp.radius = {};
    scene.set_light("lamp", lamp);
    for (const int samples : {1, 16}) {
        app::Session session = shadow_session(scene, ShadowMode::soft);
        look_from(session, Vec3d(0, -1, 10), 20);
        const LitParts lit = lit_parts(session, samples);
        float least = 1;
        for (const float part : lit.parts.pixels<float>())
            if (part >= 0) least = std::min(least, part);
        EXPECT_GT(least, 0.999f) << samples;
    }
}

}  // namespace
}  // namespace easypbr::shadow_test
