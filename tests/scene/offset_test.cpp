#include "easypbr/scene/offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "easypbr/core/error.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/scene.h"

namespace easypbr::offset_test {

namespace {

using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Points in a box of this size around a centre.
Positions points_around(const Vec3d& centre, double size, int count = 500) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> part(-0.5, 0.5);
    return Positions::NullaryExpr(count, 3, [&] { return part(random) * size; }).rowwise() +
           centre.transpose();
}

Mesh far_mesh(const Vec3d& centre, double size = 100) {
    Mesh mesh;
    mesh.set_positions(points_around(centre, size));
    return mesh;
}

Vec3d world_position(const SceneSnapshot::Object& object, Eigen::Index row) {
    return object.T_world_mesh * object.mesh->V.row(row).transpose().cast<double>();
}

}  // namespace

TEST(Offset, KeepsMillimetresOfUtmCoordinates) {
    const Positions given = points_around({691'000.25, 5'335'000.5, 520}, 2000);
    const LocalPositions local = local_positions(given);
    const Positions back = local.V.cast<double>().rowwise() + local.offset.transpose();
    // Local coordinates reach 1000 m plus what the offset was rounded by (50 m): half the spacing of float32
    // numbers below 2048 is 2^-14 m.
    EXPECT_LE((back - given).cwiseAbs().maxCoeff(), std::exp2(-14.0));
    // Without an offset they would be half a metre apart there.
    EXPECT_GT((given.cast<float>().cast<double>() - given).cwiseAbs().maxCoeff(), 0.1);
}

TEST(Offset, IsGivenByEveryWayToSetDoubles) {
    // The largest distance of a vertex from where it was given.
    const auto error_of = [](const Mesh& mesh, const Eigen::MatrixXd& given) {
        const Eigen::MatrixXd back = mesh.V().cast<double>().rowwise() + mesh.offset().transpose();
        return (back - given).cwiseAbs().maxCoeff();
    };
    const Eigen::MatrixXd V{
        {691000.1, 5335000.1, 520}, {691000.2, 5335000.1, 520}, {691000.1, 5335000.2, 520}};
    const Eigen::MatrixXi F{{0, 1, 2}};
    // Local coordinates are below 1: half the spacing of float32 numbers there is 2^-25, that of doubles
    // below 2^23 is 2^-30.
    const double rounding = std::exp2(-24.0);
    const Mesh made(V, F);
    EXPECT_LE(error_of(made, V), rounding);
    EXPECT_EQ(made.F().rows(), 1);
    Mesh set;
    set.set_V(V);
    EXPECT_LE(error_of(set, V), rounding);
    Mesh again(V, F);
    again.set_V(V);
    EXPECT_EQ(again.offset(), 2 * made.offset()) << "they are local";
    again.set_offset({0, 0, 0});
    again.set_V(V);
    EXPECT_LE(error_of(again, V), rounding);
    EXPECT_LE(error_of(Mesh(Array3d(V), F), V), rounding);
    EXPECT_LE(error_of(Mesh(V.array() * 1.0, F), V), rounding);
    EXPECT_LE(error_of(Mesh(Positions(V), Array3i()), V), rounding);
    // Beyond 2^24 float32 has not every whole number.
    const Eigen::Matrix<int64_t, Eigen::Dynamic, 3> whole{{100'000'001, 0, 0}, {100'000'002, 0, 0}};
    EXPECT_EQ(error_of(Mesh(whole, Array3i()), whole.cast<double>()), 0);
    // Floats are taken as they are, and without vertices any number of columns fits.
    EXPECT_EQ(Mesh(Eigen::MatrixXf(V.cast<float>()), F).offset(), Vec3d::Zero());
    EXPECT_EQ(Mesh(Eigen::MatrixXd(), Eigen::MatrixXi()).V().rows(), 0);
    EXPECT_THROW(Mesh(Eigen::MatrixXd::Zero(3, 2), F), ArgumentError);
}

TEST(Offset, IsRoundedToADecimalPlaceThatFitsTheExtent) {
    const Vec3d offset = local_positions(points_around({691'013.25, 5'335'017.5, 520}, 2000)).offset;
    // A quarter of the extent's 90 % is 450: hundreds.
    EXPECT_EQ(offset, Vec3d(691'000, 5'335'000, 500));
}

TEST(Offset, IsZeroWhereFloat32Holds) {
    // Nearer than 1024: numbers are at most 0.06 mm apart.
    EXPECT_EQ(local_positions(points_around({1000, 0, 0}, 1)).offset, Vec3d::Zero());
    // Far, but as large as it is far: moving it would not make numbers denser.
    EXPECT_EQ(local_positions(points_around({20'000, 0, 0}, 10'000)).offset, Vec3d::Zero());
    EXPECT_EQ(local_positions(Positions(0, 3)).offset, Vec3d::Zero());
    EXPECT_EQ(offset_of_samples({Vec3d::Constant(NAN), Vec3d::Constant(INFINITY)}), Vec3d::Zero());
    // Positions without an offset keep the bits that a plain conversion gives them.
    const Positions near = points_around({3, 4, 5}, 2);
    EXPECT_EQ(Array3f::Dense(local_positions(near).V), Array3f::Dense(near.cast<float>()));
}

TEST(Offset, IsFoundNearZeroWhereOnlyTheExtentCounts) {
    // 10 is farther than 4 times the extent of 2 from zero, but nearer than 1024.
    const std::vector<Vec3d> samples{{8, 6, 0}, {10, 6, 0}};
    EXPECT_EQ(offset_of_samples(samples), Vec3d::Zero());
    EXPECT_EQ(offset_of_samples(samples, 0), Vec3d(9, 6, 0));
    EXPECT_EQ(offset_of_samples({{3, 0, 0}, {5, 0, 0}}, 0), Vec3d::Zero());
}

TEST(Offset, HoldsForOnePointAndForEqualPoints) {
    EXPECT_EQ(local_positions(Positions{{500'000.125, 4'000'000.25, 17}}).offset,
              Vec3d(500'000, 4'000'000, 17));
    EXPECT_EQ(local_positions(Positions{{1, 2, 3}}).offset, Vec3d::Zero());
    EXPECT_EQ(local_positions(points_around({0, 123'456.75, 0}, 0)).offset, Vec3d(0, 123'457, 0));
}

TEST(Offset, StrayPointsDecideNothing) {
    Positions given = points_around({691'000, 5'335'000, 520}, 1000);
    given.row(17).setZero();
    given.row(18).setConstant(NAN);
    EXPECT_EQ(local_positions(given).offset, Vec3d(691'000, 5'335'000, 500));
}

TEST(Offset, AssigningPositionsDoesNotMoveTheWorld) {
    Mesh mesh = far_mesh({691'000, 5'335'000, 520});
    const Vec3d first = mesh.offset();
    // Local positions that are far again: what is subtracted is added.
    const Positions local = points_around({50'000, 0, 0}, 10);
    mesh.set_positions(local);
    const Vec3d world = mesh.offset() + mesh.V().row(3).transpose().cast<double>();
    EXPECT_NE(mesh.offset(), first);
    // Half the spacing below 8 m.
    EXPECT_LE((world - first - local.row(3).transpose()).cwiseAbs().maxCoeff(), std::exp2(-22.0));
    EXPECT_THROW(mesh.set_offset({0, NAN, 0}), ArgumentError);
}

TEST(Offset, TwoCloudsLandRightlyRelativeToEachOther) {
    const Vec3d here(691'000, 5'335'000, 520), step(250.125, -80.5, 3);
    Scene scene;
    scene.show(far_mesh(here), "b");
    scene.show(far_mesh(here + step), "a");
    const SceneSnapshot snapshot = scene.snapshot();
    EXPECT_EQ(snapshot.origin, scene.get("b").offset()) << "that of the mesh shown first, not first by name";
    ASSERT_EQ(snapshot.objects.size(), 2u);
    const Vec3d difference = world_position(snapshot.objects[0], 5) - world_position(snapshot.objects[1], 5);
    // Two positions with half a spacing each of numbers below 128 m.
    EXPECT_LE((difference - step).cwiseAbs().maxCoeff(), std::exp2(-17.0));
    // Positions in the scene's frame are small: the first cloud's box reaches 50 m.
    EXPECT_LT(world_position(snapshot.objects[1], 5).norm(), 150);
}

TEST(Offset, OriginStaysWithWhatWasShownFirst) {
    const Vec3d here(691'000, 5'335'000, 520);
    Scene scene;
    EXPECT_EQ(scene.origin(), Vec3d::Zero());
    scene.show(Mesh(), "empty");
    EXPECT_EQ(scene.origin(), Vec3d::Zero()) << "nothing to see decides nothing";
    scene.show(far_mesh(here), "cloud");
    const Vec3d origin = scene.origin();
    EXPECT_NE(origin, Vec3d::Zero());
    scene.show(far_mesh(here + Vec3d(5000, 0, 0)), "cloud");
    EXPECT_EQ(scene.origin(), origin) << "what is shown later is placed relative to it";
    scene.clear();
    scene.show(far_mesh({1, 2, 3}, 1), "near");
    EXPECT_EQ(scene.origin(), Vec3d::Zero());
    scene.set_origin({1, 2, 3});
    EXPECT_EQ(scene.snapshot().objects[0].T_world_mesh.translation(), Vec3d(-1, -2, -3));
    EXPECT_THROW(scene.set_origin(Vec3d::Constant(INFINITY)), ArgumentError);
}

TEST(Offset, PosesActInTheScenesFrame) {
    const Vec3d here(691'000, 5'335'000, 520);
    Mesh mesh = far_mesh(here), other = far_mesh(here + Vec3d(1000, 0, 0));
    Scene scene;
    scene.show(mesh, "a");
    scene.show(other, "b");
    const SceneSnapshot before = scene.snapshot();
    const Eigen::Affine3d turn(Eigen::AngleAxisd(0.5, Vec3d::UnitX()));
    mesh.set_T_parent_mesh(turn);
    other.set_T_parent_mesh(turn);
    const SceneSnapshot after = scene.snapshot();
    for (size_t i = 0; i < 2; ++i)
        // Rounding of double precision at 1000 m.
        EXPECT_LE((world_position(after.objects[i], 7) - turn * world_position(before.objects[i], 7)).norm(),
                  1e-9);
}

TEST(Offset, MergingKeepsTheWorld) {
    const Vec3d here(691'000, 5'335'000, 520), step(300, 40, 0);
    MeshData a = *far_mesh(here).snapshot(), b = *far_mesh(here + step).snapshot();
    const MeshData whole = merged(std::vector{a, b});
    EXPECT_EQ(whole.offset, a.offset);
    const Vec3d expected = b.offset + b.V.row(0).transpose().cast<double>();
    const Vec3d moved = whole.offset + whole.V.row(a.V.rows()).transpose().cast<double>();
    // Half the spacing below 512 m, twice rounded.
    EXPECT_LE((moved - expected).cwiseAbs().maxCoeff(), std::exp2(-15.0));

    Mesh root = Mesh(a), child = Mesh(b);
    root.add_child(child);
    const MeshData flat = flatten(root);
    EXPECT_EQ(flat.offset, a.offset);
    EXPECT_EQ(flat.V, whole.V);
}

}  // namespace easypbr::offset_test
