// Shadows against visibility by ray casting.
#include <cstdlib>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/settings.h"
#include "ray_caster.h"
#include "shadow_test.h"

namespace easypbr::shadow_visibility_test {
namespace {

constexpr int size = 192, ray_count = 64;

Scene still_life() {
    Scene scene;
    scene.show(make_plane(6), "floor");
    scene.show(make_teapot(1, 12), "teapot");
    Mesh ball = make_sphere(0.35f, 64), post = make_box(Vec3(0.06f, 1.4f, 0.06f));
    ball.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(1.1, 0.35, 0.7)));
    post.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-1.0, 0.7, 0.9)));
    scene.show(ball, "ball");
    scene.show(post, "post");
    return scene;
}

/// Point `index` of a lattice on the disc as which a light is seen from a point, far away for directional
/// ones.
Vec3d disc_point(const Light& light, const Vec3d& from, int index, int count) {
    const bool far = light.type == LightType::directional;
    const Vec3d centre =
        far ? Vec3d(from - light.direction.cast<double>().normalized()) : light.position.cast<double>();
    const double radius = far ? std::tan(radians(light.angular_radius_deg)) : double(*light.radius);
    const Vec3d axis = (from - centre).normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
    const double r = radius * std::sqrt((index + 0.5) / count), phi = index * pi * (3 - std::sqrt(5.0));
    const Vec3d point = centre + r * (std::cos(phi) * u + std::sin(phi) * v);
    return far ? Vec3d(from + (point - from) * 1e3) : point;
}

/// The part of the light that reaches a point, weighted by the cosine; -1 when none of it faces the point.
double cast_lit_part(const RayCaster& caster, const Light& light, const Vec3d& from, const Vec3d& normal) {
    const int count = light.radius.value_or(0) > 0 || light.angular_radius_deg > 0 ? ray_count : 1;
    double open = 0, all = 0;
    for (int i = 0; i < count; ++i) {
        const Vec3d to = disc_point(light, from, i, count);
        const double cosine = std::max(0.0, normal.dot((to - from).normalized()));
        all += cosine;
        if (cosine > 0 && !caster.blocked(from, to)) open += cosine;
    }
    return all > 0 ? open / all : -1;
}

/// Mean difference between the part of the light that a picture shows and the one that rays find, over the
/// pixels that the light shines on.
double mean_error(const Scene& scene, const Light& light, ShadowMode mode, int samples) {
    for (const std::string& name : scene.light_names()) Scene(scene).remove_light(name);
    Scene(scene).set_light("light", light);
    app::Session session = plain_session(scene, size);
    session.settings().shadows.mode = mode;
    session.settings().material.roughness = 1.0f;
    session.settings().material.metallic = 0.0f;
    const LitParts lit = lit_parts(session, samples);
    const Image normals = session.render_layers({"normal_world"}).at("normal_world");
    const RayCaster caster(scene.snapshot());
    std::vector<double> errors(size_t(size) * size, -1);
    parallel_for(errors.size(), 64, [&](size_t i) {
        const int x = int(i) % size, y = int(i) / size;
        if (lit.at(x, y) < 0) return;
        const Vec3d n = Vec3(normals.at<float>(x, y)).cast<double>();
        const double truth =
            cast_lit_part(caster, light, lit.position(x, y) + 1e-4 * lit.depth.at<float>(x, y)[0] * n, n);
        if (truth >= 0) errors[i] = std::abs(lit.at(x, y) - truth);
    });
    double sum = 0, count = 0;
    for (const double error : errors)
        if (error >= 0) sum += error, ++count;
    EXPECT_GT(count, 1000);
    ::testing::Test::RecordProperty(fmt::format("mean_error_mode{}_samples{}", int(mode), samples),
                                    fmt::format("{:.4f}", sum / count));
    return sum / count;
}

/// Lights around content of a centre and half diagonal: above, in the midst of it, low, and a sun.
std::vector<Light> lights_around(const Box3d& box) {
    const double unit = box.diagonal().norm() / 9;
    const auto lamp = [&](double x, double y, double z, double radius) {
        Light light = point((box.center() + Vec3d(x, y, z) * unit).cast<float>(), float(radius * unit));
        light.intensity = float(20 * unit * unit);
        return light;
    };
    return {lamp(2.5, 3.3, 3, 0.4), lamp(0.9, 0.9, 1.4, 0.15), lamp(5, 0.3, 0, 0.4),
            directional(Vec3(-1, -1.2f, -0.4f), 3)};
}

// The bounds are those the project promises: 0.02 of the light for sharp shadows, 0.05 for soft ones, in one
// frame and in a still.
void expect_agreement(const Scene& scene, const std::vector<size_t>& which) {
    const std::vector<Light> lights = lights_around(scene.snapshot().bounds());
    for (const size_t i : which) {
        Light sharp = lights[i];
        sharp.radius = sharp.angular_radius_deg = 0.0f;
        EXPECT_LE(mean_error(scene, sharp, ShadowMode::hard, 1), 0.02) << "hard, light " << i;
        EXPECT_LE(mean_error(scene, sharp, ShadowMode::pcf, 1), 0.02) << "pcf, light " << i;
        EXPECT_LE(mean_error(scene, lights[i], ShadowMode::soft, 1), 0.05) << "soft, light " << i;
        EXPECT_LE(mean_error(scene, lights[i], ShadowMode::soft, 16), 0.05) << "soft still, light " << i;
    }
}

Scene file_scene(const std::string& name) {
    Scene scene;
    scene.show(Mesh(std::filesystem::path(std::getenv("EASYPBR_TEST_DATA")) / name), name);
    return scene;
}

TEST(ShadowVisibility, StillLife) {
    expect_agreement(still_life(), {0, 1, 2, 3});
}

TEST(ShadowVisibility, Room) {
    if (!std::getenv("EASYPBR_TEST_DATA")) GTEST_SKIP() << "EASYPBR_TEST_DATA names no folder";
    expect_agreement(file_scene("room_scene.obj"), {0, 1, 2, 3});
}

// The second light's place is inside the head.
TEST(ShadowVisibility, Head) {
    if (!std::getenv("EASYPBR_TEST_DATA")) GTEST_SKIP() << "EASYPBR_TEST_DATA names no folder";
    expect_agreement(file_scene("head.obj"), {0, 2, 3});
}

}  // namespace
}  // namespace easypbr::shadow_visibility_test
