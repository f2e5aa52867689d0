// Ground truth of 3D Gaussian splats: the surface at which half of the light is stopped.
#include <gtest/gtest.h>

#include <cmath>

#include "dataset/placed_meshes.h"
#include "easypbr/dataset/ground_truth.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"
#include "render/render_test.h"

namespace easypbr::dataset::splat_truth_test {
namespace {

constexpr int side = 41, size = 96;
constexpr double distance = 4;

/// A square of flat splats in the plane z = 0, closely side by side, turned about the y axis.
Mesh wall(double angle_deg) {
    MeshData mesh;
    Array3f::Dense V(side * side, 3);
    Array1i::Dense L(side * side);
    for (int i = 0; i < side * side; ++i) {
        V.row(i) << 0.05f * float(i % side - side / 2), 0.05f * float(i / side - side / 2), 0;
        L(i) = i;
    }
    mesh.V = Array3f(V);
    mesh.L = Array1i(L);
    mesh.splats.scales = Array3f::Dense(Eigen::RowVector3f(0.04f, 0.04f, 0).replicate(side * side, 1));
    mesh.splats.rotations = Array4f::Dense(Eigen::RowVector4f(1, 0, 0, 0).replicate(side * side, 1));
    mesh.splats.opacities = Array1f::Dense::Constant(side * side, 0.95f);
    mesh.splats.sh = ArrayXf::Dense::Zero(side * side, 3);
    mesh.T_parent_mesh = Eigen::AngleAxisd(radians(angle_deg), Vec3d::UnitY());
    return Mesh(mesh);
}

GroundTruth truth_of(const Scene& scene, bool native) {
    app::Session session = plain_session(scene, size);
    session.allow_native_geometry(native);
    look_from(session, Vec3d(0, 0, distance));
    TruthOptions options;
    options.size = Vec2i(size, size);
    options.instances = true;
    return ground_truth(session, {"depth", "normal_world", "instance_id", "semantic_id", "face_id"}, options);
}

const Instance& named(const GroundTruth& truth, const std::string& name) {
    return *std::ranges::find(truth.instances, name, &Instance::name);
}

// Along a pixel's ray the plane is where x cos(a) = -z sin(a). A splat's depth falls with the plane, but for
// the part that the low-pass of 0.3 square pixels has of its variance: 14 % of 0.019 units a pixel, at 4.9
// pixels from its middle at most, where it is seen no more: 3.3 standard deviations. That of its mean alone
// would be off by 0.09.
TEST(SplatTruth, DepthNormalAndIndexAreThoseOfTheWall) {
    constexpr double angle = 40;
    Scene scene;
    scene.show(wall(angle), "wall");
    for (const bool native : {true, false}) {
        const GroundTruth truth = truth_of(scene, native);
        const double f = size / 2.0 / std::tan(radians(15.0));
        for (int y = size / 2 - 20; y < size / 2 + 20; ++y)
            for (int x = size / 2 - 20; x < size / 2 + 20; ++x) {
                const size_t i = size_t(y) * size + size_t(x);
                // (x, z) = (t s, distance - t): z = -x tan(a).
                const double s = (x + 0.5 - size / 2.0) / f;
                const double depth = distance / (1 - s * std::tan(radians(angle)));
                ASSERT_NEAR(double(truth.layers.at("depth").floats()[i]), depth, 0.013) << x << " " << y;
                ASSERT_EQ(truth.layers.at("instance_id").integers()[i], 1);
                const float* n = &truth.layers.at("normal_world").floats()[3 * i];
                ASSERT_NEAR(n[2], std::cos(radians(angle)), 1e-3);
                // A splat that is seen where the ray meets the wall: 3.3 standard deviations, and the
                // low-pass.
                const int splat = truth.layers.at("face_id").integers()[i];
                ASSERT_EQ(truth.layers.at("semantic_id").integers()[i], splat);
                const double across = s * depth / std::cos(radians(angle));
                const double up = (size / 2.0 - y - 0.5) / f * depth;
                ASSERT_NEAR(0.05 * (splat % side - side / 2), across, 0.145);
                ASSERT_NEAR(0.05 * (splat / side - side / 2), up, 0.145);
            }
    }
}

/// A splat with other semi-axes in all directions, or a ball.
Mesh one_splat(const Vec3& mean, const Vec3& scales) {
    MeshData mesh;
    mesh.V = Array3f::Dense(mean.transpose());
    mesh.splats.scales = Array3f::Dense(scales.transpose());
    mesh.splats.rotations = Array4f::Dense(Eigen::RowVector4f(0.8f, 0.36f, 0.48f, 0));
    mesh.splats.opacities = Array1f::Dense::Constant(1, 0.99f);
    mesh.splats.sh = ArrayXf::Dense::Zero(1, 3);
    return Mesh(mesh);
}

/// The depth at which one_splat() is densest along a ray from the camera's centre, (d P m) / (d P d) with the
/// inverse covariance P, in the frame of a camera at the origin that looks along -z.
double densest_depth(const Vec3& mean, const Vec3& scales, const Vec2d& slopes) {
    const Mat3d axes = Eigen::Quaterniond(0.8, 0.36, 0.48, 0).toRotationMatrix(),
                P = axes * scales.cast<double>().cwiseAbs2().cwiseInverse().asDiagonal() * axes.transpose();
    const Vec3d d(slopes.x(), -slopes.y(), -1), m = mean.cast<double>();
    return d.dot(P * m) / d.dot(P * d);
}

// From a thick splat around the camera, where the projection's derivative is far off, to a slice. Rays that
// go away from a mean beside the camera see the most of it at the near plane. A tolerance of 1e-6: depths,
// places and sizes are floats, 6e-8 each, and the slice's inverse covariance has a condition of 11.
TEST(SplatTruth, DepthIsExactWhereASplatIsDensest) {
    constexpr double focal = 52;
    const Vec2i wide(80, 60);
    const Mat3d K = (Mat3d() << focal, 0, 39.5, 0, focal, 29.5, 0, 0, 1).finished();
    const std::pair<Vec3, Vec3> every[] = {
        {Vec3(0.05f, 0, -0.006f), Vec3::Constant(0.1f)}, {Vec3(0.05f, 0, -0.02f), Vec3::Constant(0.1f)},
        {Vec3(0.1f, 0, -0.1f), Vec3::Constant(0.1f)},    {Vec3(0.2f, 0.1f, -0.2f), Vec3::Constant(0.1f)},
        {Vec3(0.1f, 0.1f, -1), Vec3(0.3f, 0.1f, 0.2f)},  {Vec3(-0.2f, 0.1f, -2), Vec3(0.5f, 0.4f, 0.15f)}};
    for (const auto& [mean, scales] : every)
        for (const bool through_lens : {false, true}) {
            Scene scene;
            scene.show(one_splat(mean, scales), "splat");
            app::Session session = plain_session(scene);
            Camera camera = opencv_camera(K, wide);
            if (through_lens)
                camera.distortion =
                    Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.1, 0, 0, 0});
            session.set_camera(camera);
            TruthOptions options;
            options.size = wide;
            const GroundTruth truth = ground_truth(session, {"depth", "position", "instance_id"}, options);
            const std::span<const float> depth = truth.layers.at("depth").floats();
            const auto ids = truth.layers.at("instance_id").integers();
            int seen = 0;
            for (size_t i = 0; i < ids.size(); ++i) {
                if (ids[i] == 0) continue;
                ++seen;
                const float* p = &truth.layers.at("position").floats()[3 * i];
                const Vec2d on_sensor((double(i % size_t(wide.x())) - 39.5) / focal,
                                      (double(i / size_t(wide.x())) - 29.5) / focal);
                const Vec2d slopes = through_lens ? Vec2d(p[0] / -p[2], p[1] / p[2]) : on_sensor;
                const double expected =
                    std::max(densest_depth(mean, scales, slopes), double(truth.camera.near));
                ASSERT_NEAR(depth[i], expected, 1e-6 * expected) << mean.transpose() << " " << i;
            }
            // The first two are drawn in all of the picture.
            EXPECT_GE(seen, mean.z() > -0.05f ? int(ids.size()) : 200) << mean.transpose();
        }
}

// A splat of some opacity a half unit before the wall: it is the surface where it stops half of the light.
TEST(SplatTruth, IsWhereHalfOfTheLightIsStopped) {
    for (const float opacity : {0.45f, 0.55f}) {
        MeshData splat;
        splat.V = Array3f::Dense(Eigen::RowVector3f(0, 0, 0.5f));
        splat.splats.scales = Array3f::Dense(Eigen::RowVector3f(2, 2, 0));
        splat.splats.rotations = Array4f::Dense(Eigen::RowVector4f(1, 0, 0, 0));
        splat.splats.opacities = Array1f::Dense::Constant(1, opacity);
        splat.splats.sh = ArrayXf::Dense::Zero(1, 3);
        Scene scene;
        scene.show(wall(0), "wall");
        scene.show(Mesh(splat), "splat");
        const GroundTruth truth = truth_of(scene, true);
        const size_t middle = size_t(size) * (size / 2) + size / 2;
        const double expected = opacity > 0.5f ? distance - 0.5 : distance;
        EXPECT_NEAR(double(truth.layers.at("depth").floats()[middle]), expected, 1e-4);
        EXPECT_EQ(truth.layers.at("instance_id").integers()[middle],
                  named(truth, opacity > 0.5f ? "splat" : "wall").id);
    }
}

// Three flat splats one behind the other, of opacity 0.5: what they add is 4 : 2 : 1, and the second stops
// more than half of the light. Before a wall that they do not count.
TEST(SplatTruth, DepthMayBeTheExpectedOne) {
    MeshData three;
    Array3f::Dense V(3, 3);
    V << 0, 0, 0.2f, 0, 0, 0.6f, 0, 0, 1.0f;
    three.V = std::move(V);
    three.splats.scales = Array3f::Dense(Eigen::RowVector3f(20, 20, 0).replicate(3, 1));
    three.splats.rotations = Array4f::Dense(Eigen::RowVector4f(1, 0, 0, 0).replicate(3, 1));
    three.splats.opacities = Array1f::Dense::Constant(3, 0.5f);
    three.splats.sh = ArrayXf::Dense::Zero(3, 3);
    for (const bool orthographic : {false, true})
        for (const bool resort : {false, true}) {
            Scene scene;
            scene.show(wall(0), "wall");
            scene.show(Mesh(three), "three");
            app::Session session = plain_session(scene, size);
            session.settings().splats.depth = SplatDepth::expected;
            session.settings().splats.resort = resort;
            if (orthographic) session.settings().camera.projection = Projection::orthographic;
            look_from(session, Vec3d(0, 0, distance));
            const Image depth = session.render_layers({"depth"}).at("depth");
            // The wall lies behind and adds 0.95 of the rest, 1/8 of the light; it is a splat too.
            const double weight = 0.5 + 0.25 + 0.125 + 0.125 * 0.95;
            const double expected = distance - (0.5 * 1.0 + 0.25 * 0.6 + 0.125 * 0.2) / weight;
            // Half a splat of the wall: its opacity is less beside the means of its splats, and several
            // overlap.
            EXPECT_NEAR(double(depth.at<float>(size / 2, size / 2)[0]), expected, 0.01)
                << orthographic << resort;
        }
}

// A square before the middle of the wall, and one half a unit behind it.
TEST(SplatTruth, MeshesAndSplatsHideEachOther) {
    Scene scene;
    scene.show(wall(0), "wall");
    for (const auto& [name, z] : {std::pair{"before", 0.5}, std::pair{"behind", -0.5}}) {
        Mesh square = facing_square(0.25f);
        square.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, z)));
        scene.show(square, name);
    }
    for (const bool native : {true, false}) {
        const GroundTruth truth = truth_of(scene, native);
        EXPECT_EQ(named(truth, "before").visible_fraction, 1);
        EXPECT_EQ(named(truth, "behind").visible_fraction, 0);
        const Instance& whole = named(truth, "wall");
        EXPECT_EQ(whole.pixels_visible + named(truth, "before").pixels_visible, whole.pixels_amodal_inside);
        EXPECT_GT(whole.pixels_visible, 1000);
    }
}

}  // namespace
}  // namespace easypbr::dataset::splat_truth_test
