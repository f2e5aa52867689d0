// Splats as data: what they may be, and what becomes of them when a mesh is changed.
#include <gtest/gtest.h>

#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/scene/cut.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/splat_basis.h"
#include "easypbr/scene/splat_transform.h"

namespace easypbr::splat_arrays_test {
namespace {

MeshData two_splats(int sh_columns = 48) {
    MeshData mesh;
    mesh.V = Array3f::Dense::Random(2, 3);
    mesh.splats.scales = Array3f::Dense(Array3f::Dense::Random(2, 3).cwiseAbs());
    mesh.splats.rotations = Array4f::Dense::Random(2, 4);
    mesh.splats.opacities = Array1f::Dense::Constant(2, 0.5f);
    mesh.splats.sh = ArrayXf::Dense::Random(2, sh_columns);
    return mesh;
}

Mat3d covariance_of(const SplatArrays& splats, Eigen::Index i) {
    const auto q = splats.rotations.row(i).cast<double>();
    const Mat3d axes = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix() *
                       splats.scales.row(i).transpose().cast<double>().asDiagonal();
    return axes * axes.transpose();
}

Vec3 color_of(const SplatArrays& splats, Eigen::Index i, const Vec3d& direction) {
    float basis[16];
    spherical_harmonics(Vec3(direction.cast<float>()), splats.degree(), basis);
    Vec3 sum(0, 0, 0);
    for (int k = 0; 3 * k < splats.sh.cols(); ++k)
        sum += basis[k] * splats.sh.row(i).segment<3>(3 * k).transpose();
    return sum;
}

TEST(SplatArrays, AreDrawnAsSplats) {
    const MeshData mesh = two_splats();
    EXPECT_EQ(natural_mode(mesh), DrawMode::splats);
    MeshData points = mesh;
    points.splats = {};
    Style style;
    style.mode = DrawMode::splats;
    EXPECT_EQ(primitive_of(points, resolve_style(points, style)), DrawMode::points);
}

TEST(SplatArrays, AreCheckedWhenTheyAreGiven) {
    EXPECT_NO_THROW(validate(two_splats()));
    const auto refuses = [](auto&& damage) {
        MeshData mesh = two_splats();
        damage(mesh.splats);
        EXPECT_THROW(validate(mesh), ArgumentError);
    };
    refuses([](SplatArrays& s) { s.opacities = {}; });
    refuses([](SplatArrays& s) { s.scales = Array3f(Array3f::Dense::Ones(3, 3)); });
    refuses([](SplatArrays& s) { s.scales = Array3f(Array3f::Dense::Constant(2, 3, -1)); });
    refuses([](SplatArrays& s) { s.scales = Array3f(Array3f::Dense::Constant(2, 3, std::nanf(""))); });
    refuses([](SplatArrays& s) { s.rotations = Array4f(Array4f::Dense::Zero(2, 4)); });
    refuses([](SplatArrays& s) { s.opacities = Array1f(Array1f::Dense::Constant(2, 1.5f)); });
    refuses([](SplatArrays& s) { s.sh = ArrayXf(ArrayXf::Dense::Zero(2, 6)); });
    refuses([](SplatArrays& s) { s.sh = ArrayXf(ArrayXf::Dense::Constant(2, 3, INFINITY)); });
}

// By the definition: covariances are M S M^T, and the colour along R d is what it was along d.
TEST(SplatArrays, TurnWithTheirMesh) {
    const MeshData mesh = two_splats();
    const Mat3d R = Eigen::AngleAxisd(1.1, Vec3d(3, -1, 2).normalized()).toRotationMatrix();
    Mat3d mirror = Mat3d::Identity(), shear = Mat3d::Identity();
    mirror(0, 0) = -1;
    shear(0, 1) = 0.5;
    for (const Mat3d& M : {R, Mat3d(2.5 * R), Mat3d(R * mirror), Mat3d(R * shear)}) {
        const SplatArrays turned = transformed_splats(mesh.splats, M);
        for (Eigen::Index i = 0; i < 2; ++i) {
            const Mat3d expected = M * covariance_of(mesh.splats, i) * M.transpose();
            // Single precision.
            EXPECT_TRUE(covariance_of(turned, i).isApprox(expected, 1e-5));
            if (M.isApprox(R * shear)) continue;
            const Mat3d U = M / std::cbrt(std::abs(M.determinant()));
            for (const Vec3d& d : {Vec3d(1, 0, 0), Vec3d(0.6, 0, -0.8), Vec3d(1, 2, 3).normalized()})
                EXPECT_TRUE(color_of(turned, i, U * d).isApprox(color_of(mesh.splats, i, d), 1e-4f));
        }
    }
}

TEST(SplatArrays, StayTogetherWithTheirMeans) {
    const MeshData mesh = two_splats();
    // A plane between the two keeps one.
    const Eigen::Index kept = mesh.V(0, 0) > mesh.V(1, 0) ? 0 : 1;
    const double middle = double(mesh.V(0, 0) + mesh.V(1, 0)) / 2;
    Array1i faces, vertices;
    const MeshData half = cut(mesh, {Eigen::Vector4d(1, 0, 0, -middle)}, true, faces, vertices);
    ASSERT_EQ(half.splats.sh.rows(), 1);
    EXPECT_EQ(half.splats.sh.row(0), mesh.splats.sh.row(kept));
    EXPECT_EQ(half.splats.rotations.row(0), mesh.splats.rotations.row(kept));
}

TEST(SplatArrays, AreMergedWithTheLargerDegree) {
    const std::vector<MeshData> both{two_splats(3), two_splats(12)};
    const MeshData whole = merged(both);
    validate(whole);
    ASSERT_EQ(whole.splats.sh.rows(), 4);
    ASSERT_EQ(whole.splats.degree(), 1);
    EXPECT_EQ(whole.splats.sh.row(0).head<3>(), both[0].splats.sh.row(0));
    EXPECT_TRUE(whole.splats.sh.row(0).tail<9>().isZero(0));
    EXPECT_EQ(whole.splats.sh.row(3), both[1].splats.sh.row(1));
    MeshData cloud = two_splats();
    cloud.splats = {};
    EXPECT_TRUE(merged(std::vector<MeshData>{both[0], cloud}).splats.empty());
}

}  // namespace
}  // namespace easypbr::splat_arrays_test
