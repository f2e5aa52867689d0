// Rectangles, discs and spheres that emit, rasterised and path traced, against integrals over their points.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "lobe_reference.h"
#include "render_test.h"

#include "easypbr/core/error.h"
#include "easypbr/scene/light_falloff.h"

namespace easypbr::area_light_test {
namespace {

const Vec3d eye(0.4, -3, 2.2);

Light area_light(LightType type, const Vec3& position, const Vec3& direction) {
    Light light;
    light.type = type;
    light.position = position.cast<double>();
    light.direction = direction;
    light.intensity = 3;
    light.size = Vec2(0.9f, 0.5f);
    light.width_axis = Vec3(1, 0.5f, 0.2f);
    light.radius = 0.4f;
    return light;
}

struct Case {
    std::string name;
    Light light;
};

/// Above a surface at z = 0, beside it, and cut by its horizon.
std::vector<Case> cases() {
    std::vector<Case> all;
    for (const auto& [name, type] : {std::pair{"rectangle", LightType::rectangle},
                                     {"disc", LightType::disc},
                                     {"sphere", LightType::sphere}}) {
        const std::string start = name;
        all.push_back({start + " above", area_light(type, Vec3(0, 0, 1), Vec3(0, 0, -1))});
        all.push_back(
            {start + " in the mirror", area_light(type, Vec3(-0.1f, 1.5f, 1.1f), Vec3(0, -1, -0.7f))});
        all.push_back({start + " beside", area_light(type, Vec3(1.2f, 0.3f, 0.8f), Vec3(-1, 0.2f, -0.3f))});
        all.push_back({start + " at the horizon", area_light(type, Vec3(0.2f, 1, 0.1f), Vec3(0, -1, 0))});
    }
    return all;
}

using Brdf = std::function<double(const Vec3d& l)>;

/// Radiance that a surface at the origin with normal +z reflects, by midpoints of a grid over the emitter; of
/// a sphere over the cone in which it is seen.
double reference_radiance(const Light& light, const Brdf& brdf) {
    constexpr int steps = 600;
    const ResolvedLight resolved(light, *light.radius);
    const Vec3d centre = light.position.cast<double>(), normal = light.direction.cast<double>().normalized();
    const double radius = double(*light.radius);
    const EmitterAxes axes = emitter_axes(resolved);
    double sum = 0;
    const auto seen = [&](const Vec3d& l, double solid_angle) {
        if (l.z() > 0) sum += brdf(l) * l.z() * solid_angle;
    };
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double u = (i + 0.5) / steps, v = (j + 0.5) / steps, phi = 2 * pi * v;
            if (light.type == LightType::sphere) {
                const double end = std::sqrt(1 - radius * radius / centre.squaredNorm());
                const double c = 1 - u * (1 - end), s = std::sqrt(1 - c * c);
                const Vec3d axis = centre.normalized(), x = axis.unitOrthogonal(), y = axis.cross(x);
                seen(axis * c + (x * std::cos(phi) + y * std::sin(phi)) * s,
                     2 * pi * (1 - end) / (steps * steps));
                continue;
            }
            const bool round = light.type == LightType::disc;
            const Vec2d at = round ? Vec2d(std::sqrt(u) * Vec2d(std::cos(phi), std::sin(phi)))
                                   : Vec2d(2 * u - 1, 2 * v - 1);
            const Vec3d way = centre + axes.x * at.x() + axes.y * at.y();
            const double cosine = -normal.dot(way.normalized()), area = emitting_area(resolved);
            if (cosine > 0) seen(way.normalized(), area * cosine / way.squaredNorm() / (steps * steps));
        }
    return sum * light.intensity;
}

Material surface(float metallic, float roughness) {
    Material m;
    m.base_color = Vec3::Constant(metallic > 0 ? 1.0f : 0.5f);
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

/// What the surface shows at the origin.
double seen(const Light& light, const Material& material, bool paths, int samples) {
    Scene scene;
    scene.show(facing_square(0.05f, material), "square");
    scene.set_light("area", light);
    app::Session session = plain_session(scene, 3);
    Settings& s = session.settings();
    s.path.enabled = paths;
    s.path.clamp = 0;
    s.shading.dielectric_f0 = 0;
    s.shading.multiple_scattering = false;
    look_from(session, eye, 1);
    return double(render_linear(session, samples).at<float>(1, 1)[0]);
}

double matt(const Vec3d&) {
    return 0.5 / pi;
}

Brdf metal(double roughness) {
    return [alpha = roughness * roughness](const Vec3d& l) {
        return reference::ggx(eye.normalized(), l, alpha, alpha);
    };
}

// 0.012: discs and spheres are polygons of 12 corners, which matters where the horizon cuts them; the Fresnel
// part that a surface of F0 = 0 has at grazing angles.
TEST(AreaLights, RasterMatt) {
    for (const Case& c : cases())
        EXPECT_NEAR(seen(c.light, surface(0, 1), false, 1) / reference_radiance(c.light, matt), 1, 0.012)
            << c.name;
}

// Without its Fresnel part, which at the horizon is some per cent. 0.005: noise of 1024 samples.
TEST(AreaLights, PathsMatt) {
    Material m = surface(0, 1);
    m.specular = 0;
    for (const Case& c : cases())
        EXPECT_NEAR(seen(c.light, m, true, 1024) / reference_radiance(c.light, matt), 1, 0.005) << c.name;
}

// Both ways to find a light, by its points and by the lobe, count: neither does alone with this little noise.
TEST(AreaLights, PathsMetal) {
    for (const float roughness : {0.15f, 0.4f, 0.8f})
        for (const Case& c : cases()) {
            const double expected = reference_radiance(c.light, metal(double(roughness)));
            EXPECT_NEAR(seen(c.light, surface(1, roughness), true, 1024), expected, 0.02 * expected + 0.002)
                << c.name << ", roughness " << roughness;
        }
}

// A linearly transformed cosine is not GGX: Heitz et al. show differences of some per cent of the lobe. At
// the horizon GGX times the cosine vanishes and a transformed cosine does not: up to half is too much there.
TEST(AreaLights, RasterMetal) {
    for (const float roughness : {0.15f, 0.4f, 0.8f})
        for (const Case& c : cases()) {
            const double expected = reference_radiance(c.light, metal(double(roughness)));
            const double part = c.name.ends_with("horizon") ? 0.5 : 0.05;
            EXPECT_NEAR(seen(c.light, surface(1, roughness), false, 1), expected, part * expected + 0.02)
                << c.name << ", roughness " << roughness;
        }
}

// Varnish over what is black: GGX of F0 = 0.04. 0.02: noise, and the roughness in 8 bits.
TEST(AreaLights, PathsVarnish) {
    Material varnished = surface(0, 1);
    varnished.base_color = Vec3::Zero();
    varnished.specular = 0;
    varnished.clearcoat = 1;
    for (const float roughness : {0.2f, 0.6f}) {
        varnished.clearcoat_roughness = roughness;
        const Vec3d v = eye.normalized();
        const Brdf lobe = metal(double(roughness));
        const Brdf varnish = [&](const Vec3d& l) {
            return lobe(l) * reference::schlick(v.dot((v + l).normalized()), 0.04);
        };
        for (const Case& c : cases()) {
            const double expected = reference_radiance(c.light, varnish);
            EXPECT_NEAR(seen(c.light, varnished, true, 1024), expected, 0.02 * expected + 0.0005)
                << c.name << ", roughness " << roughness;
        }
    }
}

TEST(AreaLights, EmitFromOneSide) {
    for (const LightType type : {LightType::rectangle, LightType::disc})
        for (const bool paths : {false, true})
            EXPECT_EQ(seen(area_light(type, Vec3(0, 0, 1), Vec3(0, 0, 1)), surface(0, 1), paths, 16), 0);
}

/// Part of a square lamp's light that is left below an edge halfway up which hides all on one side of it.
double left_beside_edge(bool paths, int samples) {
    Light lamp = area_light(LightType::rectangle, Vec3(0, 0, 2), Vec3(0, 0, -1));
    lamp.size = Vec2(1, 1);
    lamp.width_axis = Vec3(1, 0, 0);
    const auto shown = [&](bool hidden) {
        Scene scene;
        scene.show(facing_square(0.5f, surface(0, 1)), "floor");
        Mesh shade = facing_square(2, surface(0, 1));
        shade.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(2, 0, 1)));
        scene.show(shade, "shade");
        scene.set_light("lamp", lamp);
        app::Session session = plain_session(scene, 3);
        Settings& s = session.settings();
        s.path.enabled = paths;
        s.path.bounces = 0;
        s.shadows.enabled = hidden;
        s.shadows.mode = ShadowMode::soft;
        look_from(session, Vec3d(-3, 0, 0.7), 1);
        return double(render_linear(session, samples).at<float>(1, 1)[0]);
    };
    return shown(true) / shown(false);
}

/// A floor below a square lamp of width 2 at height 1.5, as it shows itself beside what is above it.
double below_lamp(const Mesh* pane) {
    Light lamp = area_light(LightType::rectangle, Vec3(0, 0, 1.5f), Vec3(0, 0, -1));
    lamp.size = Vec2(2, 2);
    Material matt_floor = surface(0, 1);
    matt_floor.specular = 0;
    Scene scene;
    scene.show(facing_square(0.5f, matt_floor), "floor");
    if (pane) scene.show(*pane, "pane");
    scene.set_light("lamp", lamp);
    app::Session session = plain_session(scene, 3);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.path.clamp = 0;
    s.path.bounces = 1;  // what goes back and forth between floor and pane is left out
    s.shadows.enabled = true;
    look_from(session, Vec3d(-3, 0, 0.7), 1);
    return double(render_linear(session, 4096).at<float>(1, 1)[0]);
}

// A pane takes its colour, and 0.04 that it reflects; at the lamp's corners 0.0025 more. What is behind it is
// found by chance: 0.36 of the hemisphere is the lamp, so that 4096 independent samples would be even within
// 0.02; Sobol's points are within half of that.
TEST(AreaLights, ShineThroughPanes) {
    Material glass = surface(0, 0);
    glass.base_color = Vec3::Constant(0.5f);
    glass.transmission = 1;
    glass.specular = 1;
    Mesh pane = facing_square(2, glass);
    pane.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
    EXPECT_NEAR(below_lamp(&pane) / below_lamp(nullptr), 0.5 * 0.96, 0.48 * 0.015);
}

// The ground catches half of the light where an edge hides half of the lamp. 0.02: noise of the points.
TEST(AreaLights, AnEdgeHidesAHalfOfWhatIsCaught) {
    Light lamp = area_light(LightType::rectangle, Vec3(0, 2, 0), Vec3(0, -1, 0));
    lamp.size = Vec2(1, 1);
    lamp.width_axis = Vec3(1, 0, 0);
    Mesh shade = facing_square(2, surface(0, 1));
    shade.set_T_world_mesh(
        Eigen::Affine3d(Eigen::Translation3d(2, 1, 0) * Eigen::AngleAxisd(-pi / 2, Vec3d::UnitX())));
    Scene scene;
    scene.show(shade, "shade");
    scene.set_light("lamp", lamp);
    app::Session session = plain_session(scene, 3);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.shadows.enabled = true;
    s.ground.mode = GroundMode::shadow;
    s.ground.height = 0.0;
    look_from(session, Vec3d(-3, 0.7, 0), 1);
    EXPECT_NEAR(double(render_linear(session, 1024).at<float>(1, 1)[3]), 0.5, 0.02);
}

// 0.02: noise of the points. Of shadow maps of 64 points on the lamp a column may stand at the edge: 0.06.
TEST(AreaLights, AnEdgeHidesAHalf) {
    EXPECT_NEAR(left_beside_edge(true, 1024), 0.5, 0.02);
    EXPECT_NEAR(left_beside_edge(false, 64), 0.5, 0.06);
}

TEST(AreaLights, RefuseWhatHasNoArea) {
    Light flat = area_light(LightType::rectangle, Vec3(0, 0, 1), Vec3(0, 0, -1));
    flat.size.y() = 0;
    Light aimless = area_light(LightType::disc, Vec3(0, 0, 1), Vec3(0, 0, 0));
    Light point = area_light(LightType::sphere, Vec3(0, 0, 1), Vec3(0, 0, 0));
    EXPECT_GT(seen(point, surface(0, 1), false, 1), 0);
    point.radius = 0.0f;
    for (const Light& light : {flat, aimless, point})
        EXPECT_THROW(seen(light, surface(0, 1), false, 1), ArgumentError);
}

}  // namespace
}  // namespace easypbr::area_light_test
