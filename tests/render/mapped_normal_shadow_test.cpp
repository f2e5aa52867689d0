// Shadows of lamps on surfaces whose shading normals are far from those of their faces.
#include <algorithm>
#include <cmath>

#include "render_test.h"
#include "tilted_normals.h"

namespace easypbr::mapped_normal_shadow_test {
namespace {

/// A square in the plane z = 0 of albedo 0.8, whose mapped normals are tilted towards +x.
Mesh tilted(double tilt_deg) {
    Material m;
    m.base_color = Vec3::Constant(0.8f);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    m.normal_texture.image = tilted_normals(radians(tilt_deg));
    return facing_square(2, m);
}

/// Of a lamp of irradiance pi at the origin, where Lambert has the albedo times the cosine.
Light lamp(LightType type, const Vec3& from) {
    Light light;
    light.type = type;
    light.direction = -from;
    light.position = 3 * from.cast<double>();
    light.intensity = float(type == LightType::point ? 9 * pi : pi);
    light.radius = 0.05f;
    return light;
}

app::Session session_of(const Scene& scene, ShadowMode mode) {
    app::Session session = plain_session(scene, 32);
    session.settings().shadows.enabled = true;
    session.settings().shadows.mode = mode;
    look_from(session, Vec3d(0, 0, 4), 20);
    return session;
}

constexpr ShadowMode modes[] = {ShadowMode::hard, ShadowMode::pcf, ShadowMode::soft};

// A plane does not shade itself, however its normals lie. 0.01: 8 bits of the normal texture.
TEST(MappedNormalShadows, StrongNormalMapsDoNotShadeTheirSurface) {
    for (const bool native : {true, false})
        for (const ShadowMode mode : modes)
            for (const double tilt : {60.0, 74.0, 80.0, 84.0}) {
                Scene scene;
                scene.show(tilted(tilt), "square");
                scene.set_light("sun", lamp(LightType::directional, Vec3(0, 0, 1)));
                app::Session session = session_of(scene, mode);
                session.allow_native_shading(native);
                const Image image = render_linear(session);
                for (const int x : {4, 16, 27})
                    EXPECT_NEAR(image.at<float>(x, 20)[0], 0.8 * std::cos(radians(tilt)), 0.01)
                        << tilt << " degrees, mode " << int(mode);
            }
}

// A sheet hides lamps behind it though its normals are turned to them, in the picture's corners, too; those
// before it shine on it.
TEST(MappedNormalShadows, SheetsHideLampsBehindThem) {
    for (const bool native : {true, false})
        for (const ShadowMode mode : modes)
            for (const LightType type : {LightType::directional, LightType::point})
                for (const double below : {5.0, 10.0, 20.0, 25.0, -10.0}) {
                    const double angle = radians(below);
                    Scene scene;
                    scene.show(tilted(60), "square");
                    scene.set_light("sun",
                                    lamp(type, Vec3(float(std::cos(angle)), 0, -float(std::sin(angle)))));
                    app::Session session = session_of(scene, mode);
                    session.allow_native_shading(native);
                    const Image image = render_linear(session);
                    float least = 10, most = 0;
                    for (int y = 0; y < 32; ++y)
                        for (int x = 0; x < 32; ++x) {
                            least = std::min(least, image.at<float>(x, y)[0]);
                            most = std::max(most, image.at<float>(x, y)[0]);
                        }
                    if (below > 0) {
                        EXPECT_EQ(most, 0) << below << " degrees, mode " << int(mode);
                    } else {
                        EXPECT_GT(least, 0.3) << "mode " << int(mode);
                    }
                }
}

// Just behind the plane the light fades out over 3.4 degrees, which shadow maps do not resolve. 0.01: 8 bits
// of normals.
TEST(MappedNormalShadows, LampsFadeBehindSheets) {
    for (const double below : {1.0, 2.0, 3.0}) {
        const double angle = radians(below);
        Scene scene;
        scene.show(tilted(60), "square");
        scene.set_light(
            "sun", lamp(LightType::directional, Vec3(float(std::cos(angle)), 0, -float(std::sin(angle)))));
        app::Session session = session_of(scene, ShadowMode::soft);
        const double most = 0.8 * std::cos(radians(30 + below)) * (1 - std::sin(angle) / 0.06);
        EXPECT_LE(render_linear(session).at<float>(16, 16)[0], most + 0.01) << below;
    }
}

// The pixels of a point are at one depth, which does not tell its face: a lamp that its normal is turned to
// shines on it, from behind the picture's plane, too.
TEST(MappedNormalShadows, PointsAreLitByTheirNormals) {
    Array3f::Dense V = Array3f::Dense::Zero(1, 3), N(1, 3);
    N << float(std::sin(radians(80))), 0, float(std::cos(radians(80)));
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    Material m;
    m.base_color = Vec3::Constant(0.8f);
    m.metallic = 0;
    m.roughness = 1;
    data.materials = {m};
    Mesh cloud(data);
    Style style;
    style.mode = DrawMode::points;
    style.point_size = 16.0f;  // pixels
    cloud.set_style(style);
    const double around = radians(120);
    for (const bool native : {true, false})
        for (const ShadowMode mode : modes) {
            Scene scene;
            scene.show(cloud, "cloud");
            scene.set_light("sun", lamp(LightType::directional,
                                        Vec3(float(std::sin(around)), 0, float(std::cos(around)))));
            app::Session session = session_of(scene, mode);
            session.allow_native_shading(native);
            session.allow_native_geometry(native);
            const Image shadowed = render_linear(session);
            session.settings().shadows.enabled = false;
            const Image plain = render_linear(session);
            EXPECT_GT(plain.at<float>(16, 16)[0], 0.5);
            for (const int x : {13, 16, 19})
                EXPECT_EQ(shadowed.at<float>(x, 16)[0], plain.at<float>(x, 16)[0])
                    << native << ", mode " << int(mode);
        }
}

}  // namespace
}  // namespace easypbr::mapped_normal_shadow_test
