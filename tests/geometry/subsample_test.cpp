#include "easypbr/geometry/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "easypbr/geometry/primitives.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::subsample_test {
namespace {

using Rows3 = Array3f::Dense;
const float nan = std::numeric_limits<float>::quiet_NaN();

MeshData line(int count) {
    MeshData data;
    Rows3 V = Rows3::Zero(count, 3);
    V.col(0) = Eigen::VectorXf::LinSpaced(count, 0, float(count - 1));
    data.V = V;
    data.I = Array1f(Array1f::Dense(V.col(0)));
    return data;
}

TEST(SubsampleRandom, TakesAsManyAsAskedEachOnceInOrder) {
    const Mesh all(line(10000)), some = subsample_random(all, 1000, 1);
    ASSERT_EQ(some.V().rows(), 1000);
    for (Eigen::Index i = 1; i < 1000; ++i) ASSERT_GT(some.V()(i, 0), some.V()(i - 1, 0));
    EXPECT_EQ(Array1f::Dense(some.I()), Array1f::Dense(some.V().col(0)))
        << "attributes go with their vertices";
    // The mean of 1000 of 0 .. 9999 is 4999.5, with a standard error of 10000 / sqrt(12 * 1000) * sqrt(0.9)
    // = 87.
    EXPECT_NEAR(some.V().col(0).mean(), 4999.5, 4 * 87);
    EXPECT_EQ(subsample_random(all, 1000, 1).V(), some.V()) << "the same seed";
    EXPECT_NE(subsample_random(all, 1000, 2).V(), some.V());
    EXPECT_EQ(subsample_random(all, 20000).V(), all.V());
    EXPECT_EQ(subsample_random(all, 0).V().rows(), 0);
    EXPECT_THROW(subsample_random(all, -1), ArgumentError);
}

TEST(SubsampleRandom, EveryVertexIsAsLikely) {
    const Mesh all(line(20));
    std::vector<int> taken(20, 0);
    for (uint64_t seed = 0; seed < 2000; ++seed) {
        const Array3f V = subsample_random(all, 5, seed).V();
        for (Eigen::Index i = 0; i < V.rows(); ++i) ++taken[size_t(V(i, 0))];
    }
    // 2000 draws of probability 1/4: 500, standard deviation sqrt(375) = 19.4.
    for (const int count : taken) EXPECT_NEAR(count, 500, 4.5 * 19.4);
}

TEST(SubsampleVoxels, TakesTheMeanOfEachCell) {
    MeshData data;
    data.V = Rows3{
        {2.25f, 0, 0}, {0.25f, 0.25f, 0.25f}, {0.75f, 0.25f, 0.5f}, {-0.25f, 0, 0}, {0.5f, 0.25f, 0.75f}};
    data.N = Rows3{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    data.C = ArrayXf(ArrayXf::Dense{{1, 1, 1}, {0, 0, 0}, {0.5f, 1, 0}, {1, 0, 0}, {0.25f, 0.5f, 0}});
    data.L = Array1i(Array1i::Dense{{9, 5, 3, 7, 5}});
    data.scalars = {{"x", Array1f(Array1f::Dense{{nan, 2, nan, 1, 4}})}};
    const auto cells = subsample_voxels(Mesh(data), 1).snapshot();
    EXPECT_NO_THROW(validate(*cells));
    ASSERT_EQ(cells->V.rows(), 3) << "by first vertex: [2, 3), [0, 1), [-1, 0)";
    EXPECT_EQ(Vec3(cells->V.row(0)), Vec3(2.25f, 0, 0));
    EXPECT_EQ(Vec3(cells->V.row(1)), Vec3(0.5f, 0.25f, 0.5f));
    EXPECT_EQ(Vec3(cells->V.row(2)), Vec3(-0.25f, 0, 0));
    EXPECT_LT((Vec3(cells->N.row(1)) - Vec3(1, 1, 0).normalized()).norm(), 1e-6f);
    EXPECT_EQ(Vec3(cells->C.row(1)), Vec3(0.25f, 0.5f, 0));
    EXPECT_EQ(Array1i::Dense(cells->L), (Array1i::Dense{{9, 5, 7}}));
    EXPECT_TRUE(std::isnan(cells->scalars[0].values[0]));
    EXPECT_EQ(cells->scalars[0].values[1], 3);
}

TEST(SubsampleVoxels, CellsAreCubesOfTheirSize) {
    const Mesh cells = subsample_voxels(make_sphere(1, 256), 0.25);
    std::set<std::array<int, 3>> seen;
    for (Eigen::Index i = 0; i < cells.V().rows(); ++i) {
        const Eigen::Array3i cell = (cells.V().row(i).transpose().array() / 0.25f).floor().cast<int>();
        EXPECT_TRUE(seen.insert({cell[0], cell[1], cell[2]}).second) << "two in one cell";
    }
    EXPECT_GT(seen.size(), 100u);
}

TEST(SubsampleVoxels, RefusesSizesThatAreNone) {
    const Mesh mesh(line(10));
    EXPECT_THROW(subsample_voxels(mesh, 0), ArgumentError);
    EXPECT_THROW(subsample_voxels(mesh, nan), ArgumentError);
    EXPECT_NE(refusal([&] { subsample_voxels(mesh, 1e-9); }).find("at most 2097152 cells"),
              std::string::npos);
    EXPECT_THROW(subsample_voxels(Mesh(), 1), ArgumentError);
    EXPECT_THROW(voxelize(Mesh(), 1), ArgumentError);
    EXPECT_EQ(subsample_voxels(Mesh(line(1)), 1).V().rows(), 1);
    MeshData equal;
    equal.V = Rows3::Constant(50, 3, 0.3f);
    EXPECT_EQ(subsample_voxels(Mesh(equal), 1e-3).V().rows(), 1);
}

TEST(Voxelize, CentresAreOnTheGrid) {
    MeshData data;
    data.V = Rows3{{0.2f, 0.1f, 0}, {0.4f, 0.3f, 0.1f}, {-0.1f, 5.2f, 0}};
    data.C = ArrayXf(ArrayXf::Dense{{0, 0, 0}, {1, 1, 1}, {1, 0, 0}});
    const auto voxels = voxelize(Mesh(data), 0.5).snapshot();
    ASSERT_EQ(voxels->V.rows(), 2);
    EXPECT_EQ(Vec3(voxels->V.row(0)), Vec3(0.25f, 0.25f, 0.25f));
    EXPECT_EQ(Vec3(voxels->V.row(1)), Vec3(-0.25f, 5.25f, 0.25f));
    EXPECT_EQ(Vec3(voxels->C.row(0)), Vec3(0.5f, 0.5f, 0.5f));
    EXPECT_EQ(voxels->voxel_size, 0.5f);
}

}  // namespace
TEST(Subsample, CellsOfSplatsHaveTheirColors) {
    MeshData data;
    data.V = Array3f::Dense{{0.25f, 0.5f, 0.5f}, {0.75f, 0.5f, 0.5f}, {1.5f, 0.5f, 0.5f}};
    data.splats.scales = Array3f::Dense::Ones(3, 3);
    data.splats.rotations = Array4f::Dense::Constant(3, 4, 0.5f);
    data.splats.opacities = Array1f::Dense::Ones(3);
    // The first harmonic is constant: a colour of 0.5 where it is 0.
    data.splats.sh = ArrayXf::Dense::Zero(3, 3);
    for (const auto& points : {subsample_voxels(Mesh(data), 1), voxelize(Mesh(data), 1)}) {
        const auto found = points.snapshot();
        EXPECT_TRUE(found->splats.empty());
        ASSERT_EQ(found->C.rows(), 2);
        EXPECT_NEAR(found->C(0, 0), 0.5f, 1e-6f);
        EXPECT_NEAR(found->C(1, 2), 0.5f, 1e-6f);
    }
}

}  // namespace easypbr::subsample_test
