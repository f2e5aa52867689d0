#include "easypbr/geometry/surfels.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/normals.h"
#include "geometry/measure.h"
#include "refusal.h"
#include "test_data.h"

namespace easypbr::surfels_test {
namespace {

using Rows3 = Array3f::Dense;

Mesh cloud(Rows3 V) {
    MeshData data;
    data.V = std::move(V);
    return Mesh(std::move(data));
}

/// Points of the plane z = 0 at (step_x * i, step_y * j), i and j from 0 to 20.
Rows3 pattern(float step_x, float step_y) {
    Rows3 V(21 * 21, 3);
    for (int i = 0; i < 21; ++i)
        for (int j = 0; j < 21; ++j) V.row(21 * i + j) << step_x * float(i), step_y * float(j), 0;
    return V;
}

constexpr int middle = 21 * 10 + 10;

/// Uniformly distributed on the unit sphere.
Rows3 ball(int count, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Rows3 V(count, 3);
    for (int i = 0; i < count; ++i)
        V.row(i) =
            Vec3d(normal(random), normal(random), normal(random)).normalized().cast<float>().transpose();
    return V;
}

/// Share of the probes that lie above or below some surfel, no farther from its plane than its larger
/// semi-axis. `shrink` makes the surfels smaller.
double coverage(const MeshData& surfels, const Array3f& probes, double shrink = 1) {
    const float largest = std::max(surfels.T.rowwise().norm().maxCoeff(), surfels.B.maxCoeff());
    const KdTree::Within near = KdTree(surfels.V).within(probes, 1.5f * largest);
    Eigen::Index covered = 0;
    for (Eigen::Index p = 0; p < probes.rows(); ++p)
        for (auto at = size_t(near.offsets[size_t(p)]); at < size_t(near.offsets[size_t(p) + 1]); ++at) {
            const Eigen::Index s = near.indices[at];
            const Vec3d step = (probes.row(p) - surfels.V.row(s)).transpose().cast<double>();
            const Vec3d t = surfels.T.row(s).transpose().cast<double>(),
                        n = surfels.N.row(s).transpose().cast<double>();
            const double first = t.norm(), second = surfels.B[s];
            const double along = step.dot(t) / (first * first),
                         aside = step.dot(n.cross(t)) / (first * second);
            if (std::hypot(along, aside) > shrink || std::abs(step.dot(n)) > std::max(first, second))
                continue;
            ++covered;
            break;
        }
    return double(covered) / double(probes.rows());
}

/// Share of the vertices whose normals point to the side of `outwards`.
double share_outwards(const Mesh& mesh, const Array3f& outwards) {
    return double((mesh.N().cwiseProduct(outwards).rowwise().sum().array() > 0).count()) /
           double(mesh.V().rows());
}

TEST(EstimateSurfels, OfASquareGridAreCirclesThroughTheCellsCorners) {
    const auto surfels = estimate_surfels(cloud(pattern(1, 1))).snapshot();
    // The cell is the unit square, whose corners are sqrt(1/2) away.
    const double radius = std::sqrt(0.5);
    EXPECT_EQ(Vec3(surfels->N.row(middle)), Vec3(0, 0, 1)) << "the plane faces the positive side";
    EXPECT_NEAR(surfels->T.row(middle).norm(), radius, 1e-6);
    EXPECT_NEAR(surfels->B[middle], radius, 1e-6);
    EXPECT_NEAR(surfels->T(middle, 2), 0, 1e-7);
}

TEST(EstimateSurfels, FollowThePatternOfThePoints) {
    const auto surfels = estimate_surfels(cloud(pattern(2, 1)), {24, {}}).snapshot();
    // The smallest ellipse through the corners of a rectangle a x b has the semi-axes a / sqrt(2) and b /
    // sqrt(2).
    EXPECT_NEAR(surfels->T.row(middle).norm(), 2 * std::sqrt(0.5), 1e-4);
    EXPECT_NEAR(surfels->B[middle], std::sqrt(0.5), 1e-4);
    EXPECT_NEAR(std::abs(surfels->T(middle, 0)), surfels->T.row(middle).norm(), 1e-4) << "longer along x";
}

TEST(EstimateSurfels, EndNearTheBorder) {
    const auto surfels = estimate_surfels(cloud(pattern(1, 1))).snapshot();
    // Outwards nothing bounds the cells of the border; they end as far away as their inner corners,
    // sqrt(1/2). The circle of that radius contains such a cell; the smallest ellipse has less area, and is a
    // few percent longer.
    const float most = std::max(surfels->T.rowwise().norm().maxCoeff(), surfels->B.maxCoeff());
    EXPECT_LT(most, 1.1 * std::sqrt(0.5));
}

TEST(EstimateSurfels, CoverAPlaneOfAnyPatternWithoutHoles) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    Rows3 V(5000, 3), probes(20000, 3);
    for (Eigen::Index i = 0; i < V.rows(); ++i) V.row(i) << uniform(random), 0, uniform(random);
    for (Eigen::Index i = 0; i < probes.rows(); ++i)
        probes.row(i) << 0.05f + 0.9f * uniform(random), 0, 0.05f + 0.9f * uniform(random);
    const auto surfels = estimate_surfels(cloud(V), {24, {}}).snapshot();
    EXPECT_EQ(Vec3(surfels->N.row(0)), Vec3(0, 1, 0)) << "ground faces up";
    // The ellipses contain the cells, which fill the plane.
    EXPECT_EQ(coverage(*surfels, probes, 1 + 1e-5), 1);
    EXPECT_LT(coverage(*surfels, probes, 0.5), 0.95) << "half as large they do not";
}

TEST(EstimateSurfels, CoverASphere) {
    const auto surfels = estimate_surfels(cloud(ball(20000))).snapshot();
    EXPECT_GE(coverage(*surfels, ball(20000, 2)), 0.9995);
    for (Eigen::Index i = 0; i < surfels->V.rows(); ++i) {
        ASSERT_NEAR(surfels->N.row(i).norm(), 1, 1e-6f);
        ASSERT_NEAR(surfels->N.row(i).dot(surfels->T.row(i).normalized()), 0, 1e-6f);
    }
}

TEST(EstimateNormals, OfASphereAreItsDirections) {
    const Mesh sphere = estimate_normals(cloud(ball(20000)));
    const Eigen::VectorXf cosines = sphere.N().cwiseProduct(sphere.V()).rowwise().sum();
    EXPECT_GT(cosines.minCoeff(), 0) << "all outwards";
    // A sixteenth neighbour is about h = sqrt(16 / 20000 * 4) = 0.057 away, a sag of h^2 / 2 over h: 1.6
    // degrees, which a lopsided neighbourhood turns the plane by at most; the mean is far below.
    EXPECT_GT(cosines.minCoeff(), std::cos(radians(2.5)));
    EXPECT_GT(cosines.mean(), std::cos(radians(0.5)));
}

TEST(EstimateNormals, AgreeAcrossSharpEdgesAndThinWalls) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
    // A box of 1 x 0.02 x 1: its sides are closer to each other than the seventh neighbour.
    Rows3 V(12000, 3), outwards(12000, 3);
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        const float side = i % 2 == 0 ? 1.0f : -1.0f;
        V.row(i) << uniform(random), 0.01f * side, uniform(random);
        outwards.row(i) << 0, side, 0;
    }
    // A few points have most of their neighbours on the other side, and no plane; with the relation of flat
    // surfaces a half of all would face inwards.
    EXPECT_GT(share_outwards(estimate_normals(cloud(V), {8, {}}), outwards), 0.97);
    // The edges of a cube.
    const auto cube = make_box().snapshot();
    Rows3 W(18000, 3), faces(18000, 3);
    for (Eigen::Index i = 0; i < W.rows(); ++i) {
        const Vec3 normal = cube->N.row(4 * (i % 6)).transpose();
        const Vec3 flat = Vec3(uniform(random), uniform(random), uniform(random));
        W.row(i) = (flat - flat.dot(normal) * normal + 0.5f * normal).transpose();
        faces.row(i) = normal.transpose();
    }
    // At a corner the best plane may stand on edge.
    EXPECT_GT(share_outwards(estimate_normals(cloud(W)), faces), 0.9995);
}

TEST(EstimateNormals, EveryPieceFacesOutwards) {
    const auto torus = make_torus(2, 0.5f, 128, 64).snapshot();
    const MeshData far = transformed(*torus, Eigen::Affine3d(Eigen::Translation3d(10, 0, 0)));
    const MeshData both = merged(std::vector{*torus, far});
    EXPECT_EQ(share_outwards(estimate_normals(cloud(both.V)), both.N), 1);
}

TEST(EstimateNormals, FaceTheViewpoint) {
    Rows3 V = pattern(1, 1);
    EXPECT_EQ(Vec3(estimate_normals(cloud(V), {8, Vec3d(10, 10, -5)}).N().row(middle)), Vec3(0, 0, -1));
    const Mesh inside = estimate_normals(cloud(ball(2000)), {16, Vec3d(0, 0, 0)});
    EXPECT_LT(inside.N().cwiseProduct(inside.V()).rowwise().sum().maxCoeff(), 0);
}

TEST(EstimateNormals, CoincidentPointsShareOne) {
    Rows3 V(882, 3);
    V << pattern(1, 1), pattern(1, 1);
    const Mesh mesh = estimate_normals(cloud(V));
    EXPECT_EQ(mesh.N().topRows(441), mesh.N().bottomRows(441));
    EXPECT_EQ(Vec3(mesh.N().row(0)), Vec3(0, 0, 1));
}

TEST(EstimateNormals, PointsOnALineGetSomePerpendicular) {
    Rows3 V(10, 3);
    for (int i = 0; i < 10; ++i) V.row(i) << float(i), float(i), 0;
    const auto surfels = estimate_surfels(cloud(V)).snapshot();
    for (int i = 0; i < 10; ++i) {
        EXPECT_NEAR(surfels->N.row(i).norm(), 1, 1e-6f);
        EXPECT_NEAR(surfels->N.row(i).dot(Vec3(1, 1, 0)), 0, 1e-5f);
        EXPECT_TRUE(surfels->T.row(i).allFinite() && std::isfinite(surfels->B[i]));
        EXPECT_GT(surfels->T.row(i).norm(), 0);
    }
}

TEST(EstimateSurfels, ScaleWithTheCloudToTheLastBit) {
    const Rows3 V = ball(3000);
    const auto small = estimate_surfels(cloud(V)).snapshot();
    const auto large = estimate_surfels(cloud(1024 * V)).snapshot();
    EXPECT_EQ(small->N, large->N);
    EXPECT_EQ(1024 * small->T, large->T);
    EXPECT_EQ(1024 * small->B, large->B);
}

TEST(EstimateSurfels, KeepWhatVerticesHave) {
    MeshData data = *make_sphere(1, 32).snapshot();
    data.C = ArrayXf(ArrayXf::Dense::Random(data.V.rows(), 3).cwiseAbs());
    data.L = Array1i(Array1i::Dense::LinSpaced(data.V.rows(), 0, int(data.V.rows()) - 1));
    data.scalars = {{"of faces", Array1f(Array1f::Dense::Zero(data.F.rows()))},
                    {"of vertices", Array1f(Array1f::Dense::Ones(data.V.rows()))}};
    data.T_parent_mesh.translation() = Vec3d(1, 2, 3);
    const auto surfels = estimate_surfels(Mesh(data), {}, true).snapshot();
    EXPECT_NO_THROW(validate(*surfels));
    EXPECT_EQ(surfels->C, data.C);
    EXPECT_EQ(surfels->L, data.L);
    EXPECT_TRUE(surfels->F.empty());
    ASSERT_EQ(surfels->scalars.size(), 1u);
    EXPECT_EQ(surfels->scalars[0].name, "of vertices");
    EXPECT_EQ(surfels->T_parent_mesh.translation(), Vec3d(1, 2, 3));
    EXPECT_LT((surfels->N - data.N).cwiseAbs().maxCoeff(), 1e-6f) << "its own normals were kept";
}

TEST(EstimateSurfels, RefuseWhatIsNoSurface) {
    const auto message = [](const Rows3& V, int k = 16) {
        return refusal([&] { estimate_surfels(cloud(V), {k, {}}); });
    };
    EXPECT_NE(message(Rows3(0, 3)).find("expected a mesh with vertices"), std::string::npos);
    EXPECT_EQ(message(Rows3::Zero(1, 3)),
              "estimate_surfels: expected at least 3 different points, got 1 in 1");
    EXPECT_EQ(message(Rows3::Ones(100, 3)),
              "estimate_surfels: expected at least 3 different points, got 1 in 100");
    EXPECT_EQ(message(pattern(1, 1), 2), "estimate_surfels: k: expected a whole number from 3 to 256, got 2");
    EXPECT_THROW(estimate_normals(cloud(pattern(1, 1)), {257, {}}), ArgumentError);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(estimate_normals(cloud(pattern(1, 1)), {16, Vec3d(0, nan, 0)}), ArgumentError);
    // More neighbours than there are points: all of them.
    EXPECT_EQ(message(Rows3{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), "taken");
}

TEST(SurfelsFromMesh, CoverItsFaces) {
    const auto sphere = make_icosphere(1, 4);
    const auto surfels = surfels_from_mesh(sphere).snapshot();
    EXPECT_EQ(surfels->N, sphere.N());
    EXPECT_TRUE(surfels->F.empty());
    EXPECT_EQ(coverage(*surfels, ball(20000)), 1);
    EXPECT_LT(coverage(*surfels, ball(20000), 0.5), 0.95);
}

TEST(SurfelsFromMesh, OfAGridAreCirclesThroughTheCellsCorners) {
    // Each quad is cut along one diagonal, so the cell within the ring of neighbours is the square all the
    // same.
    const auto surfels = surfels_from_mesh(make_plane(20, 20)).snapshot();
    EXPECT_NEAR(surfels->B[middle], std::sqrt(0.5), 1e-5);
    EXPECT_NEAR(surfels->T.row(middle).norm(), std::sqrt(0.5), 1e-5);
}

TEST(SurfelsFromMesh, LeaveOutWhatNoFaceUses) {
    MeshData data;
    data.V = Rows3{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2, 2}};
    data.F = Array3i::Dense{{1, 2, 3}, {4, 4, 4}};
    const auto surfels = surfels_from_mesh(Mesh(data)).snapshot();
    EXPECT_EQ(Array1i::Dense(surfels->source_vertex), (Array1i::Dense{{1, 2, 3}}));
    EXPECT_EQ(Vec3(surfels->N.row(0)), Vec3(0, 0, 1));
    EXPECT_NE(refusal([] { surfels_from_mesh(cloud(pattern(1, 1))); }).find("expected a mesh with faces"),
              std::string::npos);
}

TEST(RealSurfels, CoverTheBunnyAndFaceOutwards) {
    REQUIRE_TEST_DATA();
    const Mesh bunny = io::load_mesh(test_data("bunny.ply"));
    Rows3 probes(bunny.F().rows(), 3);
    for (Eigen::Index f = 0; f < bunny.F().rows(); ++f)
        probes.row(f) = (bunny.V().row(bunny.F()(f, 0)) + bunny.V().row(bunny.F()(f, 1)) +
                         bunny.V().row(bunny.F()(f, 2))) /
                        3;
    const Mesh estimated = estimate_surfels(cloud(bunny.V()));
    EXPECT_GE(coverage(*estimated.snapshot(), probes), 0.999);
    EXPECT_GE(coverage(*surfels_from_mesh(bunny).snapshot(), probes), 0.9999);
    EXPECT_GE(share_outwards(estimated, vertex_normals(bunny.V(), bunny.F())), 0.9999);
}

}  // namespace
}  // namespace easypbr::surfels_test
