#include "easypbr/scene/resolve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"
#include "point_mesh.h"

namespace easypbr::resolve_test {

namespace {

const Vec2i size(800, 600);

/// An irregular cloud away from the origin.
Mesh blob() {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    Array3f::Dense V(500, 3);
    for (auto row : V.rowwise()) row << 3 + normal(random), 0.5f * normal(random), 2 * normal(random);
    return cloud(V);
}

SceneSnapshot scene_of(const Mesh& mesh) {
    Scene scene;
    scene.show(mesh, "mesh");
    return scene.snapshot();
}

Environment constant_environment(float radiance) {
    Image image(8, 4, 3, PixelType::f32);
    for (float& value : image.pixels<float>()) value = radiance;
    return Environment(image);
}

/// Settings that light by nothing but what a test adds.
Settings unlit() {
    Settings settings;
    settings.environment.enabled = false;
    settings.lights.key.enabled = settings.lights.fill.enabled = settings.lights.rim.enabled = false;
    return settings;
}

}  // namespace

TEST(Resolve, LeavesNothingToInfer) {
    const ResolvedSettings resolved = resolve(scene_of(blob()), {}, size);
    for (const Field& field : fields()) {
        const bool is_override = field.name.starts_with("material.") || field.name.starts_with("style.");
        const Value value = field.get_inferred(resolved.settings);
        EXPECT_EQ(value.state,
                  is_override && field.can_be_automatic ? Value::State::automatic : Value::State::given)
            << field.name;
        EXPECT_TRUE(value.state != Value::State::given || is_valid(field, value)) << field.name;
    }
    EXPECT_EQ(resolved.camera.position(), resolved.settings.camera.position);
    EXPECT_EQ(resolved.lights.size(), 1u) << "the key";
    EXPECT_FALSE(resolved.environment.empty());
    EXPECT_GT(resolved.exposure, 0);
}

// Whether rays are cast depends on the picture's samples, so it is said beside the settings and never
// latched.
TEST(Resolve, RaysAreForPicturesOfManySamples) {
    const SceneSnapshot scene = scene_of(blob());
    Settings settings;
    settings.ssao.enabled = true;
    const auto traces = [&](std::optional<int> samples) {
        const ResolvedSettings resolved = resolve(scene, settings, size, samples);
        Settings latched = settings;
        latch(latched, resolved.settings);
        EXPECT_EQ(latched.rays.enabled, settings.rays.enabled);
        return resolved.traces_rays;
    };
    EXPECT_FALSE(traces(31));
    EXPECT_TRUE(traces(32));
    settings.image.samples = 64;
    EXPECT_TRUE(traces(std::nullopt)) << "image.samples";
    settings.image.samples = 16;
    EXPECT_FALSE(traces(std::nullopt));
    settings.rays.enabled = true;
    EXPECT_TRUE(traces(1));
    settings.rays.enabled = false;
    EXPECT_FALSE(traces(32));
    settings.rays.enabled = automatic;
    settings.ssao.enabled = false;
    EXPECT_FALSE(traces(32)) << "rays find what occlusion stands for";
    settings.rays.enabled = true;
    settings.environment.enabled = false;
    EXPECT_FALSE(traces(32)) << "there is no sky to look for";
}

// Scaling by a power of two changes exponents alone: every length must come out scaled, and all else the
// same, bit for bit. A constant with a length's unit anywhere would break this.
TEST(Resolve, ScalesWithTheScene) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Settings settings;
        settings.camera.projection = projection;
        settings.camera.azimuth_deg = 37;
        settings.lights.fill.enabled = settings.lights.rim.enabled = true;
        const Mesh mesh = blob();
        const ResolvedSettings one = resolve(scene_of(mesh), settings, size);
        for (const float scale : {1024.0f, 1 / 1024.0f}) {
            const ResolvedSettings other = resolve(scene_of(cloud(mesh.V() * scale)), settings, size);
            EXPECT_EQ(other.camera.T_world_cam.linear(), one.camera.T_world_cam.linear());
            EXPECT_EQ(other.camera.position(), one.camera.position() * scale);
            EXPECT_EQ(other.camera.near, one.camera.near * scale);
            EXPECT_EQ(other.camera.far, one.camera.far * scale);
            EXPECT_EQ(other.camera.ortho_height, one.camera.ortho_height * scale);
            EXPECT_EQ(other.exposure, one.exposure);
            for (size_t i = 0; i < 3; ++i) {
                EXPECT_EQ(other.lights[i].position, one.lights[i].position * scale);
                EXPECT_EQ(other.lights[i].intensity, one.lights[i].intensity * scale * scale);
            }
        }
    }
}

TEST(Resolve, GivesTheSameAgainFromLatchedValues) {
    const SceneSnapshot scene = scene_of(blob());
    Settings settings;
    settings.camera.elevation_deg = 90;
    const ResolvedSettings first = resolve(scene, settings, size);
    latch(settings, first.settings);
    const ResolvedSettings again = resolve(scene, settings, size);
    EXPECT_EQ(again.camera.T_world_cam.matrix(), first.camera.T_world_cam.matrix());
    EXPECT_EQ(again.camera.near, first.camera.near);
    EXPECT_EQ(again.exposure, first.exposure);
    for (const Field& field : fields())
        EXPECT_EQ(field.get_inferred(again.settings), field.get_inferred(first.settings)) << field.name;
}

TEST(Resolve, LatchesPinsFollowsAndReleases) {
    Settings settings;
    settings.camera.target = Vec3d(0, 0, 0);
    settings.lights.key.position = follow;
    latch(settings, resolve(scene_of(blob()), settings, size).settings);
    const Vec3d latched = *settings.camera.position;
    EXPECT_FALSE(settings.camera.position.is_pinned());
    EXPECT_TRUE(settings.camera.target.is_pinned());
    EXPECT_FALSE(settings.lights.key.position.value());
    EXPECT_TRUE(settings.lights.fill.position.value());

    // New content: what is latched stays, what follows moves along.
    const SceneSnapshot larger = scene_of(cloud(blob().V() * 3));
    const ResolvedSettings resolved = resolve(larger, settings, size);
    EXPECT_EQ(resolved.camera.position(), latched);
    EXPECT_EQ(resolved.settings.lights.fill.position, *settings.lights.fill.position);
    Settings fresh;
    fresh.camera.position = latched;
    fresh.camera.target = Vec3d(0, 0, 0);
    const Vec3d followed = resolve(larger, fresh, size).settings.lights.key.position;
    EXPECT_EQ(resolved.settings.lights.key.position, followed);

    release(settings);
    EXPECT_FALSE(settings.camera.position.value());
    EXPECT_TRUE(settings.camera.target.is_pinned());
    EXPECT_TRUE(settings.lights.key.position.is_follow());
    EXPECT_FALSE(settings.camera.near.value());
}

// What no later picture could be drawn with is not kept.
// Voxels are whole in the picture and above the ground, whether the object's style or the settings ask for
// them.
TEST(Resolve, MakesRoomForVoxels) {
    Mesh mesh = points({{0, 0, 0}, {1, 0, 0}});
    Settings settings;
    settings.camera.up = std::string("+Y");
    settings.style.mode = DrawMode::voxels;
    settings.style.voxel_size = 1.0f;
    const ResolvedSettings overridden = resolve(scene_of(mesh), settings, size);
    const Mat4d clip = overridden.camera.projection_matrix(4.0 / 3) * overridden.camera.view();
    for (const double x : {-0.5, 1.5})
        for (const double y : {-0.5, 0.5})
            for (const double z : {-0.5, 0.5}) {
                const Eigen::Vector4d corner = clip * Eigen::Vector4d(x, y, z, 1);
                EXPECT_LT(std::abs(corner.x()), corner.w());
                EXPECT_LT(std::abs(corner.y()), corner.w());
            }
    EXPECT_LE(overridden.settings.ground.height, -0.5);
    mesh.set_style(settings.style);
    settings.style = {};
    const ResolvedSettings own = resolve(scene_of(mesh), settings, size);
    EXPECT_EQ(own.camera.T_world_cam.matrix(), overridden.camera.T_world_cam.matrix());
}

TEST(Resolve, NamesAMeshThatIsTooLarge) {
    Scene scene;
    scene.show(blob(), "good");
    scene.show(cloud(Array3f::Dense{{0, 0, 0}, {1e38f, 0, 0}, {0, -2e38f, 0}}), "bad");
    try {
        resolve(scene.snapshot(), {}, size);
        ADD_FAILURE() << "resolved";
    } catch (const ArgumentError& error) {
        EXPECT_EQ(std::string(error.what()).find("mesh 'bad' has coordinates up to 2e+38"), 0u)
            << error.what();
    }
    // Where the studio's lights are off, it does not matter that they would be too bright.
    scene.show(cloud(Array3f::Dense{{0, 0, 0}, {1e30f, 0, 0}, {0, -2e30f, 0}}), "bad");
    Settings settings = unlit();
    latch(settings, resolve(scene.snapshot(), settings, size).settings);
    EXPECT_FALSE(settings.lights.key.intensity.value());
    EXPECT_TRUE(settings.camera.position.value());
    EXPECT_NO_THROW(resolve(scene.snapshot(), settings, size));
    scene.remove("bad");
    EXPECT_NO_THROW(resolve(scene.snapshot(), settings, size));
    EXPECT_NO_THROW(resolve(scene.snapshot(), {}, size));
}

// Two lights' worth of radiance is half the exposure, whatever stands in the scene.
TEST(Resolve, HalvesExposureWhenLightDoubles) {
    SceneSnapshot scene = scene_of(blob());
    Settings settings = unlit();
    scene.lights["sun"].type = LightType::directional;
    scene.lights["sun"].direction = Vec3(-0.3f, -0.5f, -1);
    const float one = resolve(scene, settings, size).exposure;
    scene.lights["sun"].intensity = 2;
    EXPECT_EQ(resolve(scene, settings, size).exposure, one / 2);
    settings.tonemap.exposure_compensation = 1;
    EXPECT_EQ(resolve(scene, settings, size).exposure, one);
    settings.tonemap.exposure = 3.0f;
    EXPECT_EQ(resolve(scene, settings, size).exposure, 6);
    EXPECT_EQ(resolve(scene_of(blob()), unlit(), size).exposure, 1) << "nothing lights the scene";
}

// A white surface under constant radiance L reflects L in every direction, so the exposure is 1 / L.
// Tolerance: the environment's irradiance is good to a percent.
TEST(Resolve, MetersAConstantEnvironment) {
    SceneSnapshot scene = scene_of(blob());
    scene.environment = constant_environment(0.25f);
    const ResolvedSettings resolved = resolve(scene, {}, size);
    EXPECT_TRUE(resolved.lights.empty()) << "with an environment given the studio's lights are off";
    EXPECT_NEAR(resolved.exposure, 4, 0.04);
    Settings twice;
    twice.environment.intensity = 2;
    EXPECT_NEAR(resolve(scene, twice, size).exposure, 2, 0.02);
}

// A sun of irradiance E from the camera's direction: the cosine-weighted mean of E cos / pi over the
// hemisphere is E / pi * (1/3) / (1/2) = 2 E / (3 pi). Tolerance: 64 midpoints in z integrate z^2 to 1 / (12
// * 64^2) of itself.
TEST(Resolve, MetersASunFromTheCamera) {
    SceneSnapshot scene = scene_of(blob());
    const Settings settings = unlit();
    const Vec3d forward = -resolve(scene, settings, size).camera.T_world_cam.linear().col(2);
    scene.lights["sun"].type = LightType::directional;
    scene.lights["sun"].direction = forward.cast<float>();
    EXPECT_NEAR(resolve(scene, settings, size).exposure, 3 * pi / 2, 1e-3);
    scene.lights["sun"].enabled = false;
    EXPECT_EQ(resolve(scene, settings, size).exposure, 1);
}

// With the camera in front (+z) and up +y: the key to the left, above and before the content, 3 radii away;
// the rim behind it. The content is a cube of half diagonal sqrt(3).
TEST(Resolve, PlacesStudioLightsAroundTheContent) {
    Settings settings;
    settings.camera.azimuth_deg = settings.camera.elevation_deg = 0;
    settings.lights.fill.enabled = settings.lights.rim.enabled = true;
    const ResolvedSettings resolved = resolve(scene_of(points({{-1, -1, -1}, {1, 1, 1}})), settings, size);
    const double d = 3 * std::sqrt(3.0), c = std::cos(radians(40)) * std::sqrt(0.5);
    const Vec3d key(-c * d, std::sin(radians(40)) * d, c * d);
    EXPECT_TRUE(resolved.lights[0].position.isApprox(key, 1e-6)) << resolved.lights[0].position;
    EXPECT_FLOAT_EQ(resolved.lights[0].intensity, float(2.0 * d * d));
    EXPECT_GT(resolved.lights[1].position.x(), 0);
    EXPECT_LT(resolved.lights[2].position.z(), 0);
    for (const ResolvedLight& light : resolved.lights) EXPECT_NEAR(light.position.norm(), d, 1e-6 * d);

    settings.lights.intensity = 0.5f;
    settings.lights.fill.enabled = false;
    const ResolvedSettings dimmed = resolve(scene_of(points({{-1, -1, -1}, {1, 1, 1}})), settings, size);
    ASSERT_EQ(dimmed.lights.size(), 2u);
    EXPECT_FLOAT_EQ(dimmed.lights[0].intensity, float(1.0 * d * d));
}

// Where a step of single precision is half a metre: the light of something 20 cm large must stand as it does
// at the origin, up to what the subtraction of two doubles leaves.
TEST(Resolve, PlacesStudioLightsFarFromTheOrigin) {
    const Vec3d place(5e5, 4.5e6, 100);
    Mesh mesh = points({{-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f}});
    const ResolvedSettings here = resolve(scene_of(mesh), {}, size);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(place)));
    Settings settings;
    latch(settings, resolve(scene_of(mesh), settings, size).settings);
    const ResolvedSettings there = resolve(scene_of(mesh), settings, size);
    EXPECT_LT((there.lights[0].position - place - here.lights[0].position).norm(), 1e-8);
}

TEST(Resolve, TakesTheGivenEnvironmentOrTheStudio) {
    SceneSnapshot scene = scene_of(blob());
    EXPECT_EQ(resolve(scene, {}, size).environment.hash(), studio_environment().hash());
    scene.environment = constant_environment(1);
    EXPECT_EQ(resolve(scene, {}, size).environment.hash(), scene.environment.hash());
    Settings settings;
    settings.environment.enabled = false;
    const ResolvedSettings without = resolve(scene, settings, size);
    EXPECT_TRUE(without.environment.empty());
    EXPECT_EQ(without.lights.size(), 1u) << "something has to light the scene";
}

TEST(Resolve, TurnsTheEnvironmentAboutUp) {
    const SceneSnapshot scene = scene_of(blob());
    Settings settings;
    EXPECT_EQ(resolve(scene, settings, size).R_env_world, Mat3(Mat3::Identity()));
    // Counter-clockwise from above by 90 degrees: what was seen towards +z is now seen towards +x.
    settings.environment.rotation_deg = 90;
    EXPECT_TRUE(
        Vec3(resolve(scene, settings, size).R_env_world * Vec3(1, 0, 0)).isApprox(Vec3(0, 0, 1), 1e-6f));
    settings.environment.rotation_deg = 0;
    for (const char* up : {"+x", "-x", "+y", "-y", "+z", "-z", "z"}) {
        settings.camera.up = up;
        const Mat3 R = resolve(scene, settings, size).R_env_world;
        EXPECT_EQ(Vec3(R * parse_up(up).cast<float>()), Vec3(0, 1, 0)) << up;
        EXPECT_NEAR(R.determinant(), 1, 1e-6) << up;
    }
    settings.camera.up = "+z";
    EXPECT_EQ(Vec3(resolve(scene, settings, size).R_env_world * Vec3(0, -1, 0)), Vec3(0, 0, 1));
}

// Depths are reversed floats: a near plane close to the camera costs nothing.
TEST(Resolve, NearPlaneLiesBeforeWhatIsNearHoweverFarTheRestIs) {
    Scene scene;
    scene.show(points({{-0.5f, 0, 0}, {0.5f, 0, 0.5f}}), "near");
    scene.show(points({{0, 0, -10000}, {500, 500, -10500}}), "far");
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Settings settings;
        settings.camera.projection = projection;
        settings.camera.pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4, 0, 0, 0, 1};
        EXPECT_NEAR(resolve(scene.snapshot(), settings, size).camera.near, 0.35, 1e-6);
        // With some of it behind the camera.
        settings.camera.pose[11] = 0.25;
        EXPECT_LT(resolve(scene.snapshot(), settings, size).camera.near, 0.1);
    }
}

// A tenth of the depth of the content; within it 1e-9 of the distance to the target.
TEST(Resolve, NearPlaneIsWhereTheFieldSaysThatItIs) {
    Scene scene;
    scene.show(points({{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}), "cube");
    const auto near_from = [&](double z) {
        Settings settings;
        settings.camera.position = Vec3d(0, 0, z);
        settings.camera.target = Vec3d(0, 0, z - 2);
        return resolve(scene.snapshot(), settings, size).camera.near;
    };
    // In double precision of a few steps.
    EXPECT_NEAR(near_from(2.5), 0.1 * 2, 1e-14);
    EXPECT_NEAR(near_from(4.5), 0.1 * 4, 1e-14);
    EXPECT_NEAR(near_from(0.25), 1e-9 * 2, 1e-22);
    EXPECT_EQ(field("camera.near").doc,
              "Distance to the near clipping plane; automatic: 0.1 of the smallest depth of the content, but "
              "at least 1e-09 of the distance to the target.");
}

// The Earth below a camera in orbit, and a satellite of 2 m at 10 m: 1e-9 of the 6.8e6 m to the middle. Clip
// coordinates are of single precision, which holds the smallest of all reversed depths, that of the farthest
// corner, to its 24 bits (1e-6 for three roundings), and its square too.
TEST(Resolve, NearPlaneLiesBeforeWhatIsNearWithinLargeContent) {
    Scene scene;
    scene.show(points({{-6.4e6f, -13.2e6f, -6.4e6f}, {6.4e6f, -4e5f, 6.4e6f}}), "planet");
    scene.show(points({{-1, -1, -11}, {1, 1, -9}}), "satellite");
    Settings settings;
    settings.camera.pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const ResolvedSettings resolved = resolve(scene.snapshot(), settings, size);
    const double near = resolved.camera.near, farthest = 6.4e6;
    EXPECT_LT(near, 0.1);
    EXPECT_GE(near, 0.99e-9 * farthest);
    const Eigen::Vector4f clip =
        resolved.camera.projection_matrix(1).cast<float>() * Eigen::Vector4f(0, 0, -float(farthest), 1);
    const float depth = clip.z() / clip.w();
    EXPECT_NEAR(double(depth), near / farthest, 1e-6 * near / farthest);
    EXPECT_GT(depth * depth, std::numeric_limits<float>::min());
}

TEST(Resolve, VoxelsAreOccludedAsSurfacesAre) {
    Scene scene;
    Mesh mesh = points({{-0.5f, 0, 0}, {0.5f, 0, 0.5f}});
    scene.show(mesh, "cloud");
    const auto is_occluded = [&] { return resolve(scene.snapshot(), {}, size).settings.ssao.enabled; };
    EXPECT_FALSE(is_occluded());
    Style style;
    style.mode = DrawMode::voxels;
    mesh.set_style(style);
    EXPECT_TRUE(is_occluded());
}

TEST(Resolve, RefusesContradictions) {
    const SceneSnapshot scene = scene_of(blob());
    const auto refuses = [&](const auto& change) {
        Settings settings;
        change(settings);
        EXPECT_THROW(resolve(scene, settings, size), ArgumentError);
    };
    const std::vector<double> pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5, 0, 0, 0, 1};
    refuses([&](Settings& s) { s.camera.pose = pose, s.camera.position = Vec3d(0, 0, 1); });
    refuses([&](Settings& s) { s.camera.pose = {1, 2, 3}; });
    refuses([&](Settings& s) { s.camera.pose = std::vector<double>(16, 1.0); });
    refuses([&](Settings& s) { s.camera.position = s.camera.target = Vec3d(1, 1, 1); });
    refuses([&](Settings& s) { s.camera.fov_y_deg = 0; });
    refuses([&](Settings& s) { s.camera.up = "up"; });
    refuses([&](Settings& s) { s.camera.intrinsics = {500, 500, 320, 240, 1e300, 480}; });
    refuses([&](Settings& s) {
        s.camera.intrinsics = {500, 500, 320, 240, 640, 480};
        s.camera.projection = Projection::orthographic;
    });
    EXPECT_THROW(resolve(scene, {}, Vec2i(0, 600)), ArgumentError);
    EXPECT_THROW(resolve(scene, {}, Vec2i(800, max_image_side + 1)), ArgumentError);
}

/// A square in the plane z = 0, of half size s.
Mesh floor_of(float s) {
    Array3f::Dense V(4, 3);
    V << -s, -s, 0, s, -s, 0, s, s, 0, -s, s, 0;
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    return {Array3f(std::move(V)), Array3i(std::move(F))};
}

float inferred_radius(const Mesh& mesh, const Light& light) {
    SceneSnapshot scene = scene_of(mesh);
    scene.lights["lamp"] = light;
    return resolve(scene, unlit(), size).light_radii.at("lamp");
}

// The radius of a square of half size s is s sqrt 2: a light gets 0.05 of it. Points and spots get half of
// the way to the surface at most, which is far from all vertices here.
TEST(Resolve, EmittersDoNotReachThroughSurfaces) {
    Light lamp;
    lamp.position = Vec3d(0, 0, 2);
    EXPECT_FLOAT_EQ(inferred_radius(floor_of(10), lamp), float(0.5 * std::sqrt(2.0)));
    EXPECT_FLOAT_EQ(inferred_radius(floor_of(50), lamp), 1);
    EXPECT_FLOAT_EQ(inferred_radius(floor_of(500), lamp), 1);
    lamp.type = LightType::spot;
    EXPECT_FLOAT_EQ(inferred_radius(floor_of(500), lamp), 1);
    lamp.position.z() = -0.5;
    EXPECT_FLOAT_EQ(inferred_radius(floor_of(500), lamp), 0.25);
    lamp.position.z() = 0;
    EXPECT_EQ(inferred_radius(floor_of(500), lamp), 0);
    // An area light may hang in a ceiling.
    lamp.type = LightType::disc;
    EXPECT_FLOAT_EQ(inferred_radius(floor_of(500), lamp), float(25 * std::sqrt(2.0)));
}

// The nearest vertex of 20 000, behind others in order, turned and shifted: 3 from the light.
TEST(Resolve, EmittersKeepClearOfPoints) {
    Array3f::Dense V = Array3f::Dense::Zero(20000, 3);
    for (Eigen::Index i = 0; i < V.rows(); ++i) V(i, 0) = 100 + float(i) / 100;
    V.row(15000).setZero();
    Mesh mesh = cloud(V);
    mesh.set_T_parent_mesh(Eigen::Translation3d(5, 0, 0) * Eigen::AngleAxisd(1, Vec3d::UnitZ()));
    Light lamp;
    lamp.position = Vec3d(5, 0, 3);
    EXPECT_FLOAT_EQ(inferred_radius(mesh, lamp), 1.5);
}

TEST(Resolve, NeedsContentOnlyToPlaceTheCamera) {
    try {
        resolve(SceneSnapshot{}, {}, size);
        FAIL();
    } catch (const ArgumentError& error) {
        EXPECT_EQ(std::string(error.what()).find("nothing to show:"), 0u) << error.what();
    }
    Settings settings;
    settings.camera.position = Vec3d(0, 0, 5);
    const ResolvedSettings resolved = resolve(SceneSnapshot{}, settings, size);
    EXPECT_EQ(resolved.settings.camera.target, Vec3d(0, 0, 0));
    EXPECT_TRUE(std::isfinite(resolved.exposure));
    // Content that is shown later gets a ground below it.
    EXPECT_FALSE(std::isfinite(resolved.settings.ground.height));
    latch(settings, resolved.settings);
    EXPECT_FALSE(settings.ground.height.value());
}

}  // namespace easypbr::resolve_test
