#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "easypbr/geometry/primitives.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::arrows_test {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The part of a regular polygon of n corners in the square of the radius to them.
double polygon(int n) {
    return n / 2.0 * std::sin(2 * pi / n);
}

double lowest(const Mesh& mesh, int axis) {
    return mesh.V().col(axis).minCoeff();
}
double highest(const Mesh& mesh, int axis) {
    return mesh.V().col(axis).maxCoeff();
}

TEST(Arrows, AreClosedAndOfTheFormOfMakeArrow) {
    const Rows starts{{1, 2, 3}, {-4, 0, 0}}, vectors{{0, -4, -3}, {0, 0, 5}};
    ArrowOptions options;
    options.scale = 1;
    options.radius = 0.25;
    options.segments = 12;
    const auto arrows = make_arrows(starts, vectors, options).snapshot();
    EXPECT_NO_THROW(validate(*arrows));
    EXPECT_EQ(arrows->V.rows(), 2 * 7 * 12);
    EXPECT_TRUE(is_closed(*arrows));
    EXPECT_EQ(euler_characteristic(*arrows), 4) << "two balls";
    // Each: a head 1.5 long and 0.625 wide, a pyramid of 12 sides, and a prism 3.5 long. Coordinates are
    // rounded to 2^-22, in volumes of an area of 10.
    const double one = polygon(12) * (1.5 / 3 * 0.625 * 0.625 + 3.5 * 0.25 * 0.25);
    EXPECT_NEAR(volume(*arrows), 2 * one, 1e-5);
    EXPECT_LT((arrows->N.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-6f);
    // Normals of round sides are half a segment beside those of the faces.
    EXPECT_GT(normal_agreement(*arrows).first, std::cos(pi / 12) - 1e-5);
    // The first vertex is the tip.
    EXPECT_LT((Vec3(arrows->V.row(0)) - Vec3(1, -2, 0)).norm(), 1e-6f);
    EXPECT_LT((Vec3(arrows->V.row(7 * 12)) - Vec3(-4, 0, 5)).norm(), 1e-6f);
}

TEST(Arrows, GoInAllDirections) {
    Rows starts = Rows::Zero(6, 3), vectors = Rows::Zero(6, 3);
    for (int i = 0; i < 6; ++i) vectors(i, i / 2) = i % 2 ? -3 : 3;
    const Mesh arrows = make_arrows(starts, vectors, {.scale = 1.0});
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(lowest(arrows, axis), -3);
        EXPECT_EQ(highest(arrows, axis), 3);
    }
    EXPECT_TRUE(is_closed(*arrows.snapshot()));
    EXPECT_GT(normal_agreement(*arrows.snapshot()).first, std::cos(pi / 12) - 1e-5);
}

TEST(Arrows, TheLongestIsAsLongAsNeighboursAreApart) {
    Rows starts(16, 3), vectors(16, 3);
    for (int i = 0; i < 16; ++i) {
        starts.row(i) << i % 4 * 0.5, 0, i / 4 * 0.5;
        vectors.row(i) << 0, 10.0 * (i + 1), 0;
    }
    // 0.5 is more than a fiftieth of the diagonal, 1.5 sqrt(2).
    EXPECT_NEAR(highest(make_arrows(starts, vectors), 1), 0.5, 1e-6);
    // The same places twice: the neighbours are those at other places.
    Rows twice(32, 3), both(32, 3);
    twice << starts, starts;
    both << vectors, vectors;
    EXPECT_NEAR(highest(make_arrows(twice, both), 1), 0.5, 1e-6);
}

TEST(Arrows, AreVisibleWhereStartsAreDense) {
    const int count = 1001;
    Rows starts = Rows::Zero(count, 3), vectors = Rows::Zero(count, 3);
    starts.col(0) = Eigen::VectorXd::LinSpaced(count, 0, 10);
    vectors.col(1).setConstant(7);
    EXPECT_NEAR(highest(make_arrows(starts, vectors), 1), 10.0 / 50, 1e-6);
    EXPECT_NEAR(highest(make_arrows(starts.topRows(1), vectors.topRows(1)), 1), 7, 1e-6) << "one: its length";
}

TEST(Arrows, ShortOnesAreSmallerCopies) {
    const Rows starts{{0, 0, 0}, {10, 0, 0}}, vectors{{0, 40, 0}, {0, 1.2, 0}};
    const Mesh arrows = make_arrows(starts, vectors, {.scale = 1.0});
    const Eigen::MatrixXf first = arrows.V().topRows(84), second = arrows.V().bottomRows(84);
    // Shafts of 40 / 40 = 1 and 1.2 / 12 = 0.1; heads are 2.5 times as wide, and 12 sides meet the axes.
    EXPECT_NEAR(first.col(0).maxCoeff(), 2.5, 1e-6);
    EXPECT_NEAR(second.col(0).maxCoeff() - 10, 0.25, 2e-6);
}

TEST(Arrows, FarFromZeroKeepTheirLength) {
    const Rows starts{{500000.123, 5400000.456, 100}, {500001.123, 5400000.456, 100}};
    const Rows vectors{{0.001, 0, 0}, {0, 0, 0.002}};
    const Mesh arrows = make_arrows(starts, vectors, {.scale = 1.0});
    EXPECT_GT(arrows.offset().norm(), 1e6);
    // Local coordinates are below 1024: float32 holds them to 2^-15 of a millimetre at 1 m.
    const Vec3d tip = arrows.V().row(0).transpose().cast<double>() + arrows.offset();
    EXPECT_LT((tip - Vec3d(500000.124, 5400000.456, 100)).norm(), 1e-4);
    const Eigen::MatrixXf first = arrows.V().topRows(84);
    EXPECT_NEAR(first.col(0).maxCoeff() - first.col(0).minCoeff(), 0.001, 1e-4);
}

TEST(Arrows, CarryValuesColoursAndLengths) {
    const Rows starts{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, vectors{{3, 4, 0}, {0, 0, 0}, {0, 2, 0}};
    ArrowOptions options;
    options.segments = 3;
    options.values = Eigen::VectorXf(Eigen::Vector3f(7, 8, 9));
    options.colors = Eigen::MatrixXf(Eigen::Matrix3f::Identity());
    const auto arrows = make_arrows(starts, vectors, options).snapshot();
    ASSERT_EQ(arrows->V.rows(), 2 * 21) << "a vector of length 0 has no arrow";
    EXPECT_EQ(scalar_named(*arrows, "length").values[0], 5);
    EXPECT_EQ(scalar_named(*arrows, "length").values[41], 2);
    EXPECT_TRUE(scalar_named(*arrows, "length").from_file) << "colours when asked for";
    EXPECT_EQ(scalar_named(*arrows, "value").values[20], 7);
    EXPECT_EQ(scalar_named(*arrows, "value").values[21], 9);
    EXPECT_FALSE(scalar_named(*arrows, "value").from_file);
    EXPECT_EQ(Vec3(arrows->C.row(0)), Vec3(1, 0, 0));
    EXPECT_EQ(Vec3(arrows->C.row(41)), Vec3(0, 0, 1));
}

TEST(Arrows, RowsThatAreNotFiniteAreLeftOut) {
    const Rows starts{{0, 0, 0}, {nan, 0, 0}, {2, 0, 0}}, vectors{{0, 1, 0}, {0, 1, 0}, {0, INFINITY, 0}};
    EXPECT_EQ(make_arrows(starts, vectors).V().rows(), 84);
    ArrowOptions strict;
    strict.strict = true;
    EXPECT_EQ(
        refusal([&] { make_arrows(starts, vectors, strict); }),
        "arrows: expected finite starts and vectors, got others in row 1 of 3; without strict the 2 that "
        "have none are left out");
    EXPECT_EQ(refusal([&] { make_arrows(starts.bottomRows(2), vectors.bottomRows(2)); }),
              "arrows: none of 2 has a finite start and vector");
    EXPECT_TRUE(make_arrows(Rows(0, 3), Rows(0, 3)).V().empty());
    EXPECT_TRUE(make_arrows(starts.topRows(1), Rows::Zero(1, 3)).V().empty());
}

TEST(Arrows, TinyAndHugeOnesAreFinite) {
    const Rows starts = Rows::Zero(2, 3);
    for (const double size : {1e-300, 1e-30, 1e30}) {
        const Rows vectors{{size, 0, 0}, {0, size, size}};
        EXPECT_NO_THROW(validate(*make_arrows(starts, vectors, {.scale = 1.0}).snapshot())) << size;
        EXPECT_TRUE(make_arrows(starts, vectors).N().allFinite()) << size;
    }
}

TEST(Arrows, WhatDoesNotFitIsRefused) {
    const Rows one = Rows::Ones(1, 3), two = Rows::Ones(2, 3);
    EXPECT_EQ(refusal([&] { make_arrows(two, one); }),
              "arrows: vectors: expected one for each of 2 starts, got 1");
    ArrowOptions options;
    options.values = Eigen::VectorXf(Eigen::VectorXf::Ones(3));
    EXPECT_EQ(refusal([&] { make_arrows(two, two, options); }),
              "arrows: values: expected one for each of 2 starts, got 3");
    EXPECT_EQ(refusal([&] { make_arrows(two, two, {.scale = 0.0}); }),
              "arrows: scale: expected a number > 0, got 0");
    EXPECT_THROW(make_arrows(two, two, {.radius = -1.0}), ArgumentError);
    EXPECT_THROW(make_arrows(two, two, {.segments = 2}), ArgumentError);
    const Eigen::MatrixXd narrow = Eigen::MatrixXd::Ones(2, 2);
    EXPECT_EQ(refusal([&] { make_arrows(narrow, two); }), "array: expected n x 3, got 2 x 2");
    EXPECT_EQ(refusal([&] { make_arrows(two, narrow.array() * 2); }), "array: expected n x 3, got 2 x 2");
}

}  // namespace
}  // namespace easypbr::arrows_test
