#include "easypbr/geometry/voxels.h"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::voxels_test {
namespace {

VoxelGrid grid() {
    return {{2, 3, 4}, Vec3d(10, 20, 30), 0.5};
}

TEST(Voxels, OccupiedCellsHaveTheirCentres) {
    std::vector<uint8_t> occupied(24, 0);
    occupied[size_t((1 * 3 + 2) * 4 + 3)] = 1;  // cell (1, 2, 3)
    occupied[0] = 7;
    const auto mesh = make_voxels(grid(), occupied).snapshot();
    ASSERT_EQ(mesh->V.rows(), 2);
    EXPECT_EQ(Vec3(mesh->V.row(0)), Vec3(10.25f, 20.25f, 30.25f));
    EXPECT_EQ(Vec3(mesh->V.row(1)), Vec3(10.75f, 21.25f, 31.75f));
    EXPECT_EQ(mesh->voxel_size, 0.5f);
}

TEST(Voxels, LabelledCellsKeepTheirLabels) {
    std::vector<int32_t> labels(24, 0);
    labels[5] = 40;
    labels[6] = -1;
    const auto mesh = make_voxels(grid(), labels).snapshot();
    EXPECT_EQ(Array1i::Dense(mesh->L), (Array1i::Dense{{40, -1}}));
    EXPECT_EQ(make_voxels(grid(), labels, -1).snapshot()->V.rows(), 23);
}

TEST(Voxels, ColouredCellsAreThoseThatAreSeen) {
    ArrayXf::Dense rgba = ArrayXf::Dense::Zero(24, 4);
    rgba.row(3) << 1, 0.5f, 0, 0.25f;
    const auto mesh = make_voxels(grid(), ArrayXf(rgba)).snapshot();
    ASSERT_EQ(mesh->C.rows(), 1);
    EXPECT_EQ(Eigen::Vector4f(mesh->C.row(0)), Eigen::Vector4f(1, 0.5f, 0, 0.25f));
    ArrayXf::Dense rgb = ArrayXf::Dense::Zero(24, 3);
    rgb(4, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(make_voxels(grid(), ArrayXf(rgb)).snapshot()->V.rows(), 23) << "black is a colour, NaN is none";
}

TEST(Voxels, NothingOccupiedIsAnEmptyMesh) {
    EXPECT_TRUE(make_voxels(grid(), std::vector<uint8_t>(24, 0)).V().empty());
    EXPECT_TRUE(make_voxels({{0, 3, 4}, {0, 0, 0}, 1}, std::vector<uint8_t>{}).V().empty());
}

TEST(Voxels, WhatDoesNotFitIsRefused) {
    EXPECT_EQ(refusal([] { make_voxels(grid(), std::vector<uint8_t>(23, 1)); }),
              "voxels: expected 24 values for 2 x 3 x 4 cells, got 23");
    const std::vector<uint8_t> one(1, 1);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(make_voxels({{1, 1, 1}, {0, 0, 0}, 0}, one), ArgumentError);
    EXPECT_THROW(make_voxels({{1, 1, 1}, {0, 0, 0}, nan}, one), ArgumentError);
    EXPECT_THROW(make_voxels({{1, 1, 1}, {0, nan, 0}, 1}, one), ArgumentError);
    EXPECT_THROW(make_voxels({{-1, -1, 1}, {0, 0, 0}, 1}, one), ArgumentError);
    EXPECT_THROW(make_voxels({{1, 1, 1}, {0, 0, 0}, 1}, ArrayXf(ArrayXf::Dense::Zero(1, 2))), ArgumentError);
}

}  // namespace
}  // namespace easypbr::voxels_test
