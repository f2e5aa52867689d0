#include "easypbr/geometry/nearest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::kd_tree_test {
namespace {

Array3f random_points(int count, int seed = 1) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::uniform_real_distribution<float> uniform(-1, 1);
    Array3f::Dense V(count, 3);
    for (float& value : V.reshaped()) value = uniform(random);
    return V;
}

TEST(KdTree, FindsWhatTryingAllFinds) {
    const Array3f points = random_points(2000), queries = random_points(50, 2);
    const KdTree::Nearest nearest = KdTree(points).nearest(queries, 9);
    for (Eigen::Index q = 0; q < queries.rows(); ++q) {
        std::vector<std::pair<float, int32_t>> all;
        for (Eigen::Index p = 0; p < points.rows(); ++p)
            all.emplace_back((points.row(p) - queries.row(q)).norm(), int32_t(p));
        std::sort(all.begin(), all.end());
        for (int j = 0; j < 9; ++j) {
            EXPECT_EQ(nearest.indices(q, j), all[size_t(j)].second);
            EXPECT_NEAR(nearest.distances(q, j), all[size_t(j)].first, 1e-6f);
        }
    }
}

TEST(KdTree, OrdersEquallyFarPointsByIndex) {
    const Array3f points = Array3f::Dense{{0, 1, 0}, {5, 5, 5}, {1, 0, 0}, {0, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    const KdTree::Nearest nearest = KdTree(points).nearest(Array3f(Array3f::Dense::Zero(1, 3)), 5);
    EXPECT_EQ(nearest.indices, (KdTree::Rows<int32_t>::Dense{{3, 0, 2, 4, 5}}));
    EXPECT_EQ(nearest.distances, (KdTree::Rows<float>::Dense{{0, 1, 1, 1, 1}}));
}

TEST(KdTree, RadiusIncludesItsBorder) {
    const Array3f points = Array3f::Dense{{0, 0, 0}, {3, 4, 0}, {0, 0, 5.001f}, {6, 0, 0}};
    const Array3f queries = Array3f::Dense{{0, 0, 0}, {100, 0, 0}, {6, 0, 0}};
    const KdTree::Within within = KdTree(points).within(queries, 5);
    EXPECT_EQ(within.offsets, (std::vector<int64_t>{0, 2, 2, 4}));
    EXPECT_EQ(within.indices, (std::vector<int32_t>{0, 1, 3, 1}));
    EXPECT_EQ(within.distances, (std::vector<float>{0, 5, 0, 5}));
    EXPECT_EQ(KdTree(points).within(queries, 0).indices, (std::vector<int32_t>{0, 3}));
}

TEST(KdTree, CoincidentPointsAreAllThere) {
    const KdTree tree{Array3f(Array3f::Dense::Constant(1000, 3, 2.0f))};
    const KdTree::Nearest nearest = tree.nearest(Array3f(Array3f::Dense::Constant(1, 3, 2.0f)), 1000);
    EXPECT_EQ(nearest.distances.maxCoeff(), 0);
    EXPECT_EQ(nearest.indices(0, 0), 0);
    EXPECT_EQ(nearest.indices(0, 999), 999);
}

TEST(KdTree, IsThereAfterItWasMovedFrom) {
    KdTree tree(Array3f::Dense{{0, 0, 0}, {1, 0, 0}});
    const KdTree taken = std::move(tree);
    EXPECT_EQ(taken.size(), 2);
    EXPECT_EQ(tree.size(), 2);
}

TEST(KdTree, RefusesWhatHasNoAnswer) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusal([] { KdTree{Array3f()}; }), "k-d tree: expected at least one point, got none");
    EXPECT_NE(refusal([&] {
                  KdTree(Array3f(Array3f::Dense{{0, nan, 0}}));
              }).find("finite"),
              std::string::npos);
    const KdTree tree(random_points(5));
    const Array3f query = Array3f::Dense{{0, 0, 0}};
    EXPECT_EQ(refusal([&] { tree.nearest(query, 6); }),
              "nearest neighbours: k: expected a whole number from 1 to 5, got 6");
    EXPECT_THROW(tree.nearest(query, 0), ArgumentError);
    EXPECT_THROW(tree.nearest(Array3f(Array3f::Dense{{nan, 0, 0}}), 1), ArgumentError);
    EXPECT_THROW(tree.within(query, nan), ArgumentError);
    EXPECT_THROW(tree.within(query, -1), ArgumentError);
    EXPECT_EQ(refusal([&] { tree.within(query, std::numeric_limits<float>::infinity()); }),
              "neighbours within a radius: expected a finite number >= 0, got inf");
    EXPECT_EQ(tree.nearest(Array3f(), 3).indices.rows(), 0) << "no query, no answer";
}

}  // namespace
}  // namespace easypbr::kd_tree_test
