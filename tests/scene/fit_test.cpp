#include <gtest/gtest.h>

#include <random>

#include "easypbr/core/error.h"
#include "easypbr/scene/resolve.h"
#include "point_mesh.h"

namespace easypbr::fit_test {

namespace {

/// Extremes of the vertices' normalised device coordinates, and the least depth.
struct Extent {
    Eigen::Array2d low = Eigen::Array2d::Constant(1e30), high = -low;
    double nearest = 1e30;
};

Extent extent_of(const SceneSnapshot& scene, const Camera& camera, double aspect) {
    Extent extent;
    const Mat4d view = camera.view(), P = camera.projection_matrix(aspect);
    for (const auto& object : scene.objects)
        for (Eigen::Index i = 0; i < object.mesh->V.rows(); ++i) {
            const Vec3d world = object.T_world_mesh * Vec3d(object.mesh->V.row(i).transpose().cast<double>());
            const Vec3d in_camera = (view * world.homogeneous()).head<3>();
            const Vec3d ndc = (P * in_camera.homogeneous()).hnormalized();
            extent.low = extent.low.min(ndc.head<2>().array());
            extent.high = extent.high.max(ndc.head<2>().array());
            extent.nearest = std::min(extent.nearest, -in_camera.z());
        }
    return extent;
}

/// One axis fills [-edge, edge] exactly and the other one lies within. Tolerance: doubles, a few hundred
/// roundings.
void expect_tight(const Extent& extent, double edge) {
    EXPECT_GT(extent.nearest, 0);
    EXPECT_GE(extent.low.minCoeff(), -edge - 1e-9);
    EXPECT_LE(extent.high.maxCoeff(), edge + 1e-9);
    const auto fills = [&](int axis) {
        return std::abs(extent.low[axis] + edge) < 1e-9 && std::abs(extent.high[axis] - edge) < 1e-9;
    };
    EXPECT_TRUE(fills(0) || fills(1)) << extent.low.transpose() << " .. " << extent.high.transpose();
}

struct RandomCase {
    SceneSnapshot scene;
    CameraSettings settings;
    Mat3d R_world_cam;
    double aspect;
};

RandomCase random_case(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    std::normal_distribution<double> normal;
    const auto rotation = [&] {
        return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized();
    };
    Array3f::Dense V(20 + random() % 60, 3);
    for (Eigen::Index i = 0; i < V.size(); ++i) V.data()[i] = float(normal(random));
    Mesh mesh = cloud(V);
    mesh.set_T_parent_mesh(Eigen::Translation3d(5 * normal(random), 5 * normal(random), 5 * normal(random)) *
                           rotation() *
                           Eigen::Scaling(0.4 + unit(random), 0.4 + unit(random), 0.4 + unit(random)));
    Scene scene;
    scene.show(mesh, "cloud");
    RandomCase result{scene.snapshot(), {}, rotation().toRotationMatrix(), 0.4 + 2 * unit(random)};
    result.settings.margin = float(0.3 * unit(random));
    result.settings.fov_y_deg = float(10 + 50 * unit(random));
    return result;
}

}  // namespace

TEST(Fit, TouchesTheMarginForRandomPoses) {
    std::mt19937 random(11);
    for (int i = 0; i < 100; ++i) {
        const RandomCase c = random_case(random);
        const Camera camera = fit_camera(c.scene, c.R_world_cam, c.settings, c.aspect);
        expect_tight(extent_of(c.scene, camera, c.aspect), 1.0 - c.settings.margin);
    }
}

// The axis with room to spare is centred: its two sides are about as far from the picture's edges.
TEST(Fit, CentresTheOtherAxis) {
    std::mt19937 random(16);
    for (int i = 0; i < 100; ++i) {
        const RandomCase c = random_case(random);
        const Camera camera = fit_camera(c.scene, c.R_world_cam, c.settings, c.aspect);
        const Extent extent = extent_of(c.scene, camera, c.aspect);
        // Two secant steps from the full slopes, for content up to a tenth of its size away: within 5 % of
        // the picture.
        EXPECT_LT((extent.low + extent.high).cwiseAbs().maxCoeff(), 0.1) << i;
    }
}

TEST(Fit, TouchesTheMarginOrthographically) {
    std::mt19937 random(12);
    for (int i = 0; i < 100; ++i) {
        RandomCase c = random_case(random);
        c.settings.projection = Projection::orthographic;
        const Camera camera = fit_camera(c.scene, c.R_world_cam, c.settings, c.aspect);
        expect_tight(extent_of(c.scene, camera, c.aspect), 1.0 - c.settings.margin);
    }
}

// What is left of the picture is fitted into, with its margin, and the other axis is centred in it.
TEST(Fit, LeavesInsetsFree) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 100; ++i) {
        RandomCase c = random_case(random);
        const bool orthographic = i % 2;
        if (orthographic) c.settings.projection = Projection::orthographic;
        const Insets in{0.4 * unit(random), 0.4 * unit(random), 0.4 * unit(random), 0.4 * unit(random)};
        const Camera camera = fit_camera(c.scene, c.R_world_cam, c.settings, c.aspect, in);
        Extent extent = extent_of(c.scene, camera, c.aspect);
        // In coordinates of the free rectangle, from -1 to 1.
        const Eigen::Array2d low(2 * in.left - 1, 2 * in.bottom - 1), high(1 - 2 * in.right, 1 - 2 * in.top);
        const Eigen::Array2d middle = (low + high) / 2, half = (high - low) / 2;
        extent.low = (extent.low - middle) / half;
        extent.high = (extent.high - middle) / half;
        expect_tight(extent, 1.0 - c.settings.margin);
        // As in CentresTheOtherAxis; exact without perspective.
        EXPECT_LT((extent.low + extent.high).cwiseAbs().maxCoeff(), orthographic ? 1e-4 : 0.15) << i;
    }
}

TEST(Fit, TouchesTheMarginWithAnOffCentrePrincipalPoint) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 100; ++i) {
        RandomCase c = random_case(random);
        c.settings.intrinsics = {600 + 300 * unit(random),
                                 600 + 300 * unit(random),
                                 640 * unit(random),
                                 480 * unit(random),
                                 640,
                                 480};
        const Camera camera = fit_camera(c.scene, c.R_world_cam, c.settings, 640.0 / 480);
        expect_tight(extent_of(c.scene, camera, 640.0 / 480), 1.0 - c.settings.margin);
    }
}

// The whole way: settings to camera, from any side (the poles included) and for any up axis.
TEST(Fit, TouchesTheMarginThroughResolve) {
    std::mt19937 random(14);
    std::uniform_real_distribution<float> turn(-180, 180);
    const std::vector<std::string> ups = {"+y", "+z", "-x", "-y"};
    for (int i = 0; i < 100; ++i) {
        RandomCase c = random_case(random);
        Settings settings;
        settings.camera = c.settings;
        settings.camera.azimuth_deg = turn(random);
        settings.camera.elevation_deg = i % 5 == 0 ? 90 : i % 5 == 1 ? -90 : turn(random) / 2;
        settings.camera.up = ups[size_t(i) % ups.size()];
        const Vec2i size(640, int(640 / c.aspect));
        const Camera camera = resolve(c.scene, settings, size).camera;
        const Extent extent = extent_of(c.scene, camera, double(size.x()) / size.y());
        expect_tight(extent, 1.0 - c.settings.margin);
        EXPECT_GT(extent.nearest, camera.near);
    }
}

// Azimuth 0 looks from the front, positive azimuth from further right, elevation from above; +z up has its
// front at -y.
TEST(Fit, LooksFromTheSideThatWasAskedFor) {
    CameraSettings settings;
    settings.azimuth_deg = settings.elevation_deg = 0;
    const auto from = [&] { return Vec3d(view_rotation(settings).col(2)); };
    EXPECT_TRUE(from().isApprox(Vec3d(0, 0, 1), 1e-12));
    settings.azimuth_deg = 90;
    EXPECT_TRUE(from().isApprox(Vec3d(1, 0, 0), 1e-12));
    settings.elevation_deg = 30;
    EXPECT_NEAR(from().y(), 0.5, 1e-12);
    settings.up = "+z";
    settings.azimuth_deg = settings.elevation_deg = 0;
    EXPECT_TRUE(from().isApprox(Vec3d(0, -1, 0), 1e-12));
    settings.azimuth_deg = 90;
    EXPECT_TRUE(from().isApprox(Vec3d(1, 0, 0), 1e-12));
    EXPECT_THROW(parse_up("w"), ArgumentError);
    EXPECT_EQ(parse_up("-z"), Vec3d(0, 0, -1));
    EXPECT_EQ(parse_up("x"), Vec3d(1, 0, 0));
}

TEST(Fit, KeepsAPinnedTargetCentred) {
    std::mt19937 random(15);
    for (int i = 0; i < 50; ++i) {
        RandomCase c = random_case(random);
        Settings settings;
        settings.camera = c.settings;
        const Vec3d target = c.scene.bounds().center() + Vec3d(0.3, -0.2, 0.1);
        settings.camera.target = target;
        const Vec2i size(640, int(640 / c.aspect));
        const double aspect = double(size.x()) / size.y(), edge = 1.0 - c.settings.margin;
        const Camera camera = resolve(c.scene, settings, size).camera;
        const Vec3d ndc =
            (camera.projection_matrix(aspect) * camera.view() * target.homogeneous()).hnormalized();
        EXPECT_NEAR(ndc.head<2>().norm(), 0, 1e-12);
        // As near as possible: one side is touched, none is crossed.
        const Extent extent = extent_of(c.scene, camera, aspect);
        EXPECT_NEAR(std::max(extent.high.maxCoeff(), -extent.low.minCoeff()), edge, 1e-9);
    }
}

TEST(Fit, LooksAtTheMiddleFromAPinnedPosition) {
    const Mesh mesh = points({{0, 0, 0}, {2, 4, 6}});
    Scene scene;
    scene.show(mesh, "mesh");
    Settings settings;
    settings.camera.position = Vec3d(10, 10, 10);
    EXPECT_EQ(resolve(scene.snapshot(), settings, {800, 600}).settings.camera.target, Vec3d(1, 2, 3));
    // From the middle itself there is no direction to it; the camera then looks as the automatic one.
    settings.camera.position = Vec3d(1, 2, 3);
    const Camera inside = resolve(scene.snapshot(), settings, {800, 600}).camera;
    EXPECT_TRUE(inside.T_world_cam.linear().isApprox(view_rotation(settings.camera), 1e-12));
}

TEST(Fit, TakesAPoseAndIntrinsicsAsTheyAre) {
    Scene scene;
    scene.show(points({{0, 0, 0}, {1, 1, 1}}), "mesh");
    Settings settings;
    settings.camera.pose = {0, 0, 1, 4, 0, 1, 0, 5, -1, 0, 0, 6, 0, 0, 0, 1};
    settings.camera.intrinsics = {500, 510, 300, 200, 640, 480};
    const Camera camera = resolve(scene.snapshot(), settings, {640, 480}).camera;
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> pose(settings.camera.pose.data());
    EXPECT_EQ(camera.T_world_cam.matrix(), Mat4d(pose));
    const Mat3d K = (Mat3d() << 500, 0, 300, 0, 510, 200, 0, 0, 1).finished();
    EXPECT_TRUE(camera.opencv_K(640, 480).isApprox(K, 1e-14));
}

TEST(Fit, CopesWithContentWithoutExtent) {
    const std::vector<Mesh> meshes = {
        points({{0, 0, 0}}), points({{7, 8, 9}}), points({{0, 0, -1}, {0, 0, 1}}),
        points({{1e12f, 0, 0}, {-1e12f, 0, 0}}), points({{1e-30f, 0, 0}, {0, 0, 0}})};
    for (const Mesh& mesh : meshes) {
        Scene scene;
        scene.show(mesh, "mesh");
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Settings settings;
            settings.camera.projection = projection;
            settings.camera.azimuth_deg = settings.camera.elevation_deg = 0;
            const ResolvedSettings resolved = resolve(scene.snapshot(), settings, {800, 600});
            EXPECT_TRUE(resolved.camera.projection_matrix(4.0 / 3).allFinite());
            EXPECT_TRUE(resolved.camera.T_world_cam.matrix().allFinite());
            const Extent extent = extent_of(scene.snapshot(), resolved.camera, 4.0 / 3);
            EXPECT_GT(extent.nearest, resolved.camera.near);
            EXPECT_LE(extent.high.maxCoeff(), 1);
        }
    }
    EXPECT_THROW(fit_camera({}, Mat3d::Identity(), {}, 1), ArgumentError);
}

}  // namespace easypbr::fit_test
