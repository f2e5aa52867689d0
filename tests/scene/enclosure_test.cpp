// Cameras within closed content: its key light and its exposure.
#include <gtest/gtest.h>

#include <cmath>

#include "easypbr/scene/resolve.h"
#include "point_mesh.h"

namespace easypbr::enclosure_test {
namespace {

const Vec2i size(400, 300);

/// A cube around the origin, of half size s, without the first of its faces: the side -x has two.
Mesh room(float s = 1, int without = 0) {
    Array3f::Dense V(8, 3);
    for (int i = 0; i < 8; ++i) V.row(i) << (i & 4 ? s : -s), (i & 2 ? s : -s), (i & 1 ? s : -s);
    Array3i::Dense all(12, 3);
    all << 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7,
        1, 7, 3;
    return {Array3f(std::move(V)), Array3i(Array3i::Dense(all.bottomRows(12 - without)))};
}

/// A square of half size `half` at a height z, whose front faces +z or -z.
Mesh square(float z, float half, bool upwards) {
    Array3f::Dense V(4, 3);
    V << -half, -half, z, half, -half, z, half, half, z, -half, half, z;
    Array3i::Dense F(2, 3);
    if (upwards)
        F << 0, 1, 2, 0, 2, 3;
    else
        F << 0, 2, 1, 0, 3, 2;
    return {Array3f(std::move(V)), Array3i(std::move(F))};
}

void make_emissive(Mesh& mesh, float radiance) {
    Material material;
    material.emissive = Vec3::Constant(radiance);
    mesh.set_material(material);
}

SceneSnapshot snapshot_of(const Mesh& mesh) {
    Scene scene;
    scene.show(mesh, "room");
    return scene.snapshot();
}

/// A camera that looks along z, with a white key.
Settings looking(double from, double to) {
    Settings settings;
    settings.camera.up = std::string("+y");
    settings.camera.position = Vec3d(0, 0, from);
    settings.camera.target = Vec3d(0, 0, to);
    settings.lights.key.color = Vec3(1, 1, 1);
    return settings;
}

/// Whether the key stands three radii away from the content, as it does outside.
bool is_outside(const SceneSnapshot& scene, const Settings& settings) {
    const Vec3d position = resolve(scene, settings, size).settings.lights.key.position;
    return std::abs(position.norm() - 3 * std::sqrt(3.0)) < 1e-6;
}

}  // namespace

// From the middle of a cube of half size 1, walls are between 1 and sqrt 3 away. The lamp stands 0.2 of that
// distance d to the upper left, and gives the irradiance 2 at d before the camera. It is atan 0.2 off the
// axis, so that what is metered is within 2 % of 2 E / (3 pi); with what walls of reflectance 0.6 send back
// 3.25 times as much.
TEST(Enclosure, HasTheKeyBesideTheCamera) {
    const ResolvedSettings resolved = resolve(snapshot_of(room()), looking(0, -1), size);
    ASSERT_EQ(resolved.lights.size(), 1u);
    const ResolvedLight& key = resolved.lights[0];
    EXPECT_LT(key.position.x(), 0);
    EXPECT_NEAR(key.position.y(), -key.position.x(), 1e-12);
    EXPECT_NEAR(key.position.z(), 0, 1e-12);
    const double aside = key.position.norm(), d = aside / 0.2;
    EXPECT_GT(d, 1);
    EXPECT_LT(d, std::sqrt(3.0));
    EXPECT_FLOAT_EQ(key.radius, float(aside / 2));
    EXPECT_FLOAT_EQ(key.intensity, float(2 * (d * d + aside * aside)));
    EXPECT_NEAR(resolved.exposure, 3 * pi / 4 / 3.25, 0.02 * 3 * pi / 4 / 3.25);
}

// The wall behind the camera is 0.1 away: the lamp has half of the way. The wall in front is 1.9 away or
// more, so that 0.2 of the distance is farther.
TEST(Enclosure, KeepsTheKeyClearOfSurfaces) {
    const ResolvedSettings resolved = resolve(snapshot_of(room()), looking(-0.9, 1), size);
    // V is in single precision: -0.9 is the camera's own.
    EXPECT_NEAR((resolved.lights[0].position - resolved.camera.position()).norm(), 0.05, 1e-12);
}

// Without a side a sixth of the directions is open, more than the sixteenth that windows may have.
TEST(Enclosure, IsContentAroundTheCamera) {
    EXPECT_FALSE(is_outside(snapshot_of(room()), looking(0, -1)));
    EXPECT_TRUE(is_outside(snapshot_of(room(1, 2)), looking(0, -1)));
    EXPECT_TRUE(is_outside(snapshot_of(room()), looking(5, -1))) << "the camera is outside";
    Mesh glass = room();
    Material material;
    material.transmission = 1;
    glass.set_material(material);
    EXPECT_TRUE(is_outside(snapshot_of(glass), looking(0, -1)));
    material.transmission = 0;
    material.opacity = 0.5f;
    glass.set_material(material);
    EXPECT_TRUE(is_outside(snapshot_of(glass), looking(0, -1)));
    Settings settings = looking(0, -1);
    settings.style.mode = DrawMode::points;
    EXPECT_TRUE(is_outside(snapshot_of(room()), settings)) << "corners alone are drawn";
}

// What is given lights the content as it is.
TEST(Enclosure, LeavesGivenLightsAlone) {
    SceneSnapshot scene = snapshot_of(room());
    scene.lights["lamp"].position = Vec3d(0, 0.5, 0);
    EXPECT_TRUE(is_outside(scene, looking(0, -1)));
    scene.lights["lamp"].enabled = false;
    EXPECT_FALSE(is_outside(scene, looking(0, -1)));
    Settings settings = looking(0, -1);
    settings.environment.file = "sky.hdr";
    EXPECT_TRUE(is_outside(scene, settings));
    EXPECT_FALSE(resolve(scene, settings, size).settings.lights.key.enabled);
    settings = looking(0, -1);
    settings.lights.key.position = Vec3d(0.5, 0.5, 0.5);
    EXPECT_EQ(resolve(scene, settings, size).settings.lights.key.position, Vec3d(0.5, 0.5, 0.5));
}

TEST(Enclosure, ScalesWithTheContent) {
    const ResolvedSettings one = resolve(snapshot_of(room()), looking(0.5, -1), size);
    const ResolvedSettings other = resolve(snapshot_of(room(1024)), looking(512, -1024), size);
    EXPECT_EQ(other.lights[0].position, one.lights[0].position * 1024);
    EXPECT_EQ(other.lights[0].intensity, one.lights[0].intensity * 1024 * 1024);
    EXPECT_EQ(other.lights[0].radius, one.lights[0].radius * 1024);
    EXPECT_EQ(other.exposure, one.exposure);
}

// As all lights it stays where it is when the camera moves.
TEST(Enclosure, LatchesTheKey) {
    const SceneSnapshot scene = snapshot_of(room());
    Settings settings = looking(0, -1);
    const ResolvedSettings first = resolve(scene, settings, size);
    latch(settings, first.settings);
    settings.camera.position = Vec3d(0, 0, 5);
    const ResolvedSettings again = resolve(scene, settings, size);
    EXPECT_EQ(again.lights, first.lights);
    EXPECT_EQ(again.exposure, first.exposure);
}

// A lamp of radiance L and area A, d away in front of a surface, gives it the irradiance L A / d^2, which is
// metered as 2 E / (3 pi). Tolerance: the lamp's size, (0.1 / 10)^2, and the meter's 64 directions, 1e-4.
TEST(Enclosure, MetersEmissiveMeshesWhereNothingElseLights) {
    Scene scene;
    Mesh lamp = square(10, 0.1f, false);
    scene.show(lamp, "lamp");
    scene.show(square(-10, 0.1f, true), "floor");
    Settings settings = looking(30, 0);
    settings.environment.enabled = false;
    settings.lights.key.enabled = false;
    EXPECT_EQ(resolve(scene.snapshot(), settings, size).exposure, 1) << "nothing emits";
    make_emissive(lamp, 1000);
    const double expected = 3 * pi / 2 / (1000 * 0.04 / 100);
    EXPECT_NEAR(resolve(scene.snapshot(), settings, size).exposure, expected, 1e-3 * expected);
    settings.lights.key.enabled = true;
    const float with_key = resolve(scene.snapshot(), settings, size).exposure;
    make_emissive(lamp, 1);
    EXPECT_EQ(resolve(scene.snapshot(), settings, size).exposure, with_key) << "the key alone is metered";
}

// In a closed room both are: the key is as bright as a lamp, so that pictures without the lamp's light, those
// of one sample, are readable at the same exposure. Walls of radiance 100 give more than ten times the
// irradiance 2, as any half of them does.
TEST(Enclosure, HasAKeyAsBrightAsItsLamps) {
    Mesh mesh = room();
    const ResolvedSettings dark = resolve(snapshot_of(mesh), looking(0, -1), size);
    make_emissive(mesh, 100);
    const ResolvedSettings lit = resolve(snapshot_of(mesh), looking(0, -1), size);
    EXPECT_EQ(lit.lights[0].position, dark.lights[0].position);
    EXPECT_GT(lit.lights[0].intensity, 10 * dark.lights[0].intensity);
    EXPECT_LT(lit.exposure, dark.exposure / 10);
}

}  // namespace easypbr::enclosure_test
