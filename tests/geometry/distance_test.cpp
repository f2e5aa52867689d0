#include "easypbr/geometry/nearest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/sample.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::distance_test {
namespace {

using Rows3 = Array3f::Dense;

/// Another way: the foot of the perpendicular when it is inside, else the nearest of the nearest points of
/// the edges.
double distance_by_cases(const Vec3d& p, const std::array<Vec3d, 3>& t) {
    const Vec3d n = (t[1] - t[0]).cross(t[2] - t[0]);
    if (n.norm() > 0) {
        const Vec3d foot = p - n * (p - t[0]).dot(n) / n.squaredNorm();
        bool is_inside = true;
        for (size_t k = 0; k < 3; ++k) is_inside &= (t[(k + 1) % 3] - t[k]).cross(foot - t[k]).dot(n) >= 0;
        if (is_inside) return (p - foot).norm();
    }
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 3; ++k) {
        const Vec3d a = t[k], d = t[(k + 1) % 3] - a;
        const double s = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
        least = std::min(least, (p - a - s * d).norm());
    }
    return least;
}

TEST(NearestOnTriangle, AgreesWithTheDistanceFoundByCases) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto point = [&] { return Vec3d(uniform(random), uniform(random), uniform(random)); };
    for (int i = 0; i < 20000; ++i) {
        std::array<Vec3d, 3> t{point(), point(), point()};
        if (i % 10 == 1) t[1] = t[0];
        if (i % 10 == 2) t[2] = t[1];
        if (i % 10 == 3) t[2] = t[0];
        if (i % 10 == 4) t[2] = t[1] = t[0];
        if (i % 10 == 5) t[2] = t[0] + 0.3 * (t[1] - t[0]);
        const Vec3d p = 2 * point();
        ASSERT_NEAR((nearest_on_triangle(p, t[0], t[1], t[2]) - p).norm(), distance_by_cases(p, t), 1e-9)
            << i;
    }
}

TEST(SurfaceTree, FindsTheNearestOfAllFaces) {
    const auto torus = make_torus(1, 0.4f, 24, 12).snapshot();
    std::mt19937 random(8);
    std::uniform_real_distribution<float> uniform(-1.6f, 1.6f);
    Rows3 queries(300, 3);
    for (float& value : queries.reshaped()) value = uniform(random);
    const SurfaceTree::Nearest nearest = SurfaceTree(*torus).nearest(queries);
    for (size_t i = 0; i < 300; ++i) {
        const Vec3d p = queries.row(Eigen::Index(i)).transpose().cast<double>();
        double least = std::numeric_limits<double>::infinity();
        for (Eigen::Index f = 0; f < torus->F.rows(); ++f)
            least = std::min(least, distance_by_cases(p, {corner(*torus, f, 0), corner(*torus, f, 1),
                                                          corner(*torus, f, 2)}));
        ASSERT_NEAR(nearest.distance[i], least, 1e-9);
        ASSERT_NEAR((nearest.point[i] - p).norm(), least, 1e-9);
        const Eigen::Index f = nearest.face[i];
        ASSERT_NEAR(distance_by_cases(p, {corner(*torus, f, 0), corner(*torus, f, 1), corner(*torus, f, 2)}),
                    least, 1e-9);
    }
}

TEST(SurfaceTree, OfACloudIsItsVertices) {
    MeshData cloud;
    cloud.V = Rows3{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    const SurfaceTree::Nearest nearest =
        SurfaceTree(cloud).nearest(Array3f(Rows3{{0.9f, 0, 0}, {0, 1.1f, 0}}));
    EXPECT_EQ(nearest.face, (std::vector<int32_t>{1, 2}));
    EXPECT_NEAR(nearest.distance[1], 0.9, 1e-6);
    EXPECT_THROW(SurfaceTree(MeshData{}), ArgumentError);
    for (const int32_t index : {-1, 3}) {
        MeshData torn = cloud;
        torn.F = Array3i::Dense{{0, 1, index}};
        EXPECT_THROW(SurfaceTree{torn}, ArgumentError) << index;
    }
    EXPECT_THROW(SurfaceTree(cloud).nearest(Array3f(Rows3{{0, NAN, 0}})), ArgumentError);
}

TEST(SurfaceTree, IsThereAfterItWasMovedFrom) {
    SurfaceTree tree(*make_box().snapshot());
    const SurfaceTree taken = std::move(tree);
    const Array3f corner = Rows3{{0.5f, 0.5f, 0.5f}};
    EXPECT_EQ(tree.nearest(corner).distance, taken.nearest(corner).distance);
}

TEST(SurfaceDistance, OfParallelPlanesIsTheirGap) {
    Mesh above = make_plane(2, 4);
    above.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0.25, 0)));
    const SurfaceDistance distance = surface_distance(above, make_plane(2, 3));
    EXPECT_NEAR(distance.max, 0.25, 1e-7);
    EXPECT_NEAR(distance.mean, 0.25, 1e-7);
    EXPECT_NEAR(distance.root_mean_square, 0.25, 1e-7);
}

TEST(SurfaceDistance, IsOneSided) {
    // Every point of the small square lies on the large one; the large one's corners are sqrt(2) from the
    // small one's.
    const Mesh small = make_plane(2), large = make_plane(4);
    EXPECT_NEAR(surface_distance(small, large).max, 0, 1e-7);
    EXPECT_NEAR(surface_distance(large, small).max, std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(hausdorff_distance(small, large), std::sqrt(2.0), 1e-6);
    // Mean over the border of width 1: four strips 2 x 1 of mean 1/2 and four corner squares of mean
    // (sqrt(2) + asinh(1)) / 3 = 0.76520 (the mean distance of a unit square from its corner); over the area
    // of 16.
    const double mean = (4 * 2 * 0.5 + 4 * (std::sqrt(2.0) + std::asinh(1.0)) / 3) / 16;
    // 100000 stratified samples: far better than sigma / sqrt(n) = 0.0014.
    EXPECT_NEAR(surface_distance(large, small).mean, mean, 0.0014);
    // Over the vertices alone: the four corners.
    EXPECT_NEAR(surface_distance(large, small, 0).mean, std::sqrt(2.0), 1e-6);
}

TEST(SurfaceDistance, OfConcentricSpheres) {
    const SurfaceDistance distance = surface_distance(make_icosphere(1.5f, 4), make_icosphere(1, 4), 20000);
    // 0.5, and the spheres' faces are at most h^2 / 6 = 0.0012 (h = 0.083, times the radius) below their
    // vertices.
    EXPECT_NEAR(distance.mean, 0.5, 0.003);
    EXPECT_NEAR(distance.max, 0.5, 0.003);
}

TEST(SurfaceDistance, CountsDescendantsAndRefusesNothing) {
    Mesh parent, child = make_plane(2);
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 3, 0)));
    parent.add_child(child);
    EXPECT_NEAR(surface_distance(parent, make_plane(2)).max, 3, 1e-6);
    EXPECT_THROW(surface_distance(Mesh(), make_plane()), ArgumentError);
    EXPECT_THROW(surface_distance(make_plane(), Mesh()), ArgumentError);
    EXPECT_THROW(surface_distance(make_plane(), make_plane(), -1), ArgumentError);
}

TEST(SurfaceDistance, IsThatOfPlacesWithTheirOffsets) {
    const Vec3d utm(691000, 5335000, 520);
    Mesh a = make_box(), b = make_box();
    a.set_offset(utm);
    b.set_offset(utm + Vec3d(10, 0, 0));
    // The far side of a box of 1 is 10 from that of the other.
    EXPECT_NEAR(surface_distance(a, b).max, 10, 1e-6);
    EXPECT_NEAR(hausdorff_distance(a, b), 10, 1e-6);
    b.set_offset(utm);
    EXPECT_NEAR(surface_distance(a, b).max, 0, 1e-9);
}

TEST(SampleSurface, IsUniformByArea) {
    // Two triangles with areas 3 : 1.
    MeshData data;
    data.V = Rows3{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {10, 0, 0}, {11, 0, 0}, {10, 2, 0}};
    data.F = Array3i::Dense{{0, 1, 2}, {3, 4, 5}};
    const auto points = sample_surface(Mesh(data), 4001, 5).snapshot();
    EXPECT_NEAR(double((points->V.col(0).array() > 5).count()), 4001 / 4.0, 1)
        << "stratified: give or take one";
    Vec2d sum = Vec2d::Zero();
    int inside = 0;
    for (Eigen::Index i = 0; i < points->V.rows(); ++i) {
        const double x = points->V(i, 0), y = points->V(i, 1);
        if (x > 5) continue;
        ASSERT_GE(x, 0);
        ASSERT_LE(x / 3 + y / 2, 1 + 1e-6);
        sum += Vec2d(x, y);
        ++inside;
    }
    // Centroid (1, 2/3); standard deviations of a coordinate are sqrt(1/18) of the side: 0.71 and 0.47.
    EXPECT_NEAR(sum.x() / inside, 1, 4 * 0.71 / std::sqrt(3000.0));
    EXPECT_NEAR(sum.y() / inside, 2.0 / 3, 4 * 0.47 / std::sqrt(3000.0));
}

TEST(SampleSurface, InterpolatesWhatVerticesHave) {
    MeshData data;
    data.V = Rows3{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.F = Array3i::Dense{{0, 1, 2}};
    data.UV = Array2f::Dense{{0, 0}, {1, 0}, {0, 1}};
    data.C = ArrayXf(ArrayXf::Dense{{0, 0, 1, 1}, {1, 0, 1, 1}, {0, 1, 1, 0}});
    data.L = Array1i(Array1i::Dense{{4, 5, 6}});
    data.scalars = {{"x", Array1f(Array1f::Dense{{0, 1, 0}})}, {"face", Array1f(Array1f::Dense{{7}})}};
    const auto points = sample_surface(Mesh(data), 500).snapshot();
    EXPECT_NO_THROW(validate(*points));
    for (Eigen::Index i = 0; i < 500; ++i) {
        const float x = points->V(i, 0), y = points->V(i, 1);
        ASSERT_NEAR(points->UV(i, 0), x, 1e-6f);
        ASSERT_NEAR(points->C(i, 1), y, 1e-6f);
        ASSERT_NEAR(points->C(i, 3), 1 - y, 1e-6f);
        ASSERT_EQ(points->L[i], x > y && x > 1 - x - y ? 5 : y > 1 - x - y ? 6 : 4);
        ASSERT_NEAR(points->scalars[0].values[i], x, 1e-6f);
        ASSERT_EQ(points->scalars[1].values[i], 7);
        ASSERT_EQ(Vec3(points->N.row(i)), Vec3(0, 0, 1));
    }
    EXPECT_EQ(sample_surface(Mesh(data), 500).V(), points->V) << "the same seed";
    EXPECT_NE(sample_surface(Mesh(data), 500, 1).V(), points->V);
}

TEST(SampleSurface, NormalsOfASphereAreItsDirections) {
    const Mesh points = sample_surface(make_icosphere(2, 4), 2000);
    for (Eigen::Index i = 0; i < 2000; ++i) {
        ASSERT_NEAR(points.N().row(i).norm(), 1, 1e-6f);
        // Interpolated normals of a sphere are right to the third order of the edge, 0.08.
        ASSERT_GT(points.N().row(i).dot(points.V().row(i).normalized()), 0.99999f);
    }
}

TEST(SampleSurface, RefusesWhatHasNoArea) {
    MeshData line;
    line.V = Rows3{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.F = Array3i::Dense{{0, 1, 2}};
    EXPECT_NE(refusal([&] { sample_surface(Mesh(line), 10); }).find("expected faces with an area"),
              std::string::npos);
    EXPECT_THROW(sample_surface(Mesh(), 10), ArgumentError);
    EXPECT_THROW(sample_surface(make_box(), -1), ArgumentError);
    EXPECT_EQ(sample_surface(make_box(), 0).V().rows(), 0);
}

}  // namespace
}  // namespace easypbr::distance_test
