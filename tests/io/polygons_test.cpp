#include "easypbr/io/tables/polygons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"

namespace easypbr::io::polygons_test {
namespace {

using Corners = std::vector<Vec3>;

/// One polygon, whose corners are the vertices that `order` names, as triangles.
MeshData triangles_of(const Corners& corners, std::vector<int32_t> order = {}, uint64_t looks = most_looks) {
    if (order.empty()) {
        order.resize(corners.size());
        std::iota(order.begin(), order.end(), 0);
    }
    Array3f::Dense V(Eigen::Index(corners.size()), 3);
    for (size_t i = 0; i < corners.size(); ++i) V.row(Eigen::Index(i)) = corners[i].transpose();
    MeshData mesh;
    mesh.V = std::move(V);
    Polygons polygons;
    polygons.rows = 1;
    polygons.width = order.size();
    polygons.values = Eigen::Map<const Eigen::VectorXi>(order.data(), Eigen::Index(order.size()));
    triangulate(std::move(polygons), mesh, looks);
    EXPECT_EQ(size_t(mesh.F.rows()), order.size() - 2);
    return mesh;
}

/// Twice the area of each triangle along a direction.
std::vector<double> doubled_areas(const MeshData& mesh, const Vec3d& normal = Vec3d::UnitZ()) {
    std::vector<double> areas;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
        const auto at = [&](int k) { return Vec3d(mesh.V.row(mesh.F(f, k)).transpose().cast<double>()); };
        areas.push_back((at(1) - at(0)).cross(at(2) - at(0)).dot(normal));
    }
    return areas;
}

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

double least(const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
}

Corners flat(const std::vector<std::pair<float, float>>& points) {
    Corners corners;
    for (const auto& [x, y] : points) corners.emplace_back(x, y, 0.0f);
    return corners;
}

/// Twice the signed area, by the shoelace formula.
double outline_area(const Corners& corners) {
    double area = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = corners[i].cast<double>(), b = corners[(i + 1) % corners.size()].cast<double>();
        area += a.x() * b.y() - a.y() * b.x();
    }
    return area;
}

/// A square of 3 x 3 without its middle upper square and the one below: 9 - 2.
const std::vector<std::pair<float, float>> letter_u{{0, 3}, {0, 0}, {3, 0}, {3, 3},
                                                    {2, 3}, {2, 1}, {1, 1}, {1, 3}};

// All numbers are small and whole, so that areas are exact.
TEST(Polygons, ConcaveOnesAreCoveredOnceFromEveryFirstCorner) {
    const std::vector<std::pair<float, float>> arrow{{0, 0}, {3, 1}, {3, 0}, {5, 2}, {3, 4}, {3, 3}, {0, 4}};
    // Its head is 4, its tail a trapezium of 3 x (4 + 2) / 2.
    for (const auto& [points, area] : {std::pair{letter_u, 7.0}, {arrow, 13.0}})
        for (size_t first = 0; first < points.size(); ++first) {
            Corners corners = flat(points);
            std::rotate(corners.begin(), corners.begin() + ptrdiff_t(first), corners.end());
            const std::vector<double> areas = doubled_areas(triangles_of(corners));
            EXPECT_EQ(sum(areas), 2 * area) << first;
            EXPECT_GE(least(areas), 0) << first << ": one turned over";
        }
}

TEST(Polygons, ClockwiseOnesStayClockwise) {
    Corners corners = flat(letter_u);
    std::reverse(corners.begin(), corners.end());
    const std::vector<double> areas = doubled_areas(triangles_of(corners), -Vec3d::UnitZ());
    EXPECT_EQ(sum(areas), 14);
    EXPECT_GE(least(areas), 0);
}

TEST(Polygons, HolesBehindABridgeStayHoles) {
    // A square of 3 x 3 with a hole of 1 x 1, joined by an edge that is passed in both directions; once by
    // the same vertices and once by others at the same places.
    const Corners corners = flat({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {1, 2}, {2, 2}, {2, 1}});
    const std::vector<int32_t> order{0, 1, 2, 3, 0, 4, 5, 6, 7, 4};
    Corners repeated;
    for (const int32_t i : order) repeated.push_back(corners[size_t(i)]);
    for (const MeshData& mesh : {triangles_of(corners, order), triangles_of(repeated)}) {
        EXPECT_EQ(sum(doubled_areas(mesh)), 16);
        EXPECT_GE(least(doubled_areas(mesh)), 0);
        for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
            const Vec3 middle =
                (mesh.V.row(mesh.F(f, 0)) + mesh.V.row(mesh.F(f, 1)) + mesh.V.row(mesh.F(f, 2))).transpose() /
                3;
            EXPECT_FALSE((middle.head<2>() - Vec2(1.5f, 1.5f)).cwiseAbs().maxCoeff() < 0.49f) << f;
        }
    }
}

Corners spiral_of(int corners) {
    Corners spiral;
    const auto add = [&](int i, float width) {
        const float angle = 0.6f * float(i), radius = 1 + width + 0.3f * angle;
        spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0f);
    };
    for (int i = 0; i < corners / 2; ++i) add(i, 0.3f);
    for (int i = corners / 2; i-- > 0;) add(i, 0);
    return spiral;
}

TEST(Polygons, ASpiralOfFortyCorners) {
    const Corners corners = spiral_of(40);
    const std::vector<double> areas = doubled_areas(triangles_of(corners));
    EXPECT_NEAR(sum(areas), outline_area(corners), 1e-12) << "the rounding of sums in double precision";
    EXPECT_GE(least(areas), 0);
}

TEST(Polygons, TiltedAndBentOnes) {
    // The plane x + 2 y + 3 z = 0, by vectors within it of whole numbers.
    const Vec3d u(3, 0, -1), v(-2, 10, -6), normal = u.cross(v);
    Corners tilted, bent;
    for (const auto& [x, y] : letter_u) {
        tilted.push_back((double(x) * u + double(y) * v).cast<float>());
        bent.emplace_back(x, y, 0.25f * x * y);
    }
    const std::vector<double> areas = doubled_areas(triangles_of(tilted), normal / normal.squaredNorm());
    EXPECT_NEAR(sum(areas), 14, 1e-12) << "the rounding of the division";
    EXPECT_GE(least(areas), 0);
    const std::vector<double> seen = doubled_areas(triangles_of(bent));
    EXPECT_EQ(sum(seen), 14) << "seen from above it is the same";
    EXPECT_GE(least(seen), 0);
}

TEST(Polygons, RepeatedCornersAndCornersOnALine) {
    Corners corners = flat(letter_u);
    corners.insert(corners.begin() + 3, {Vec3(3, 1, 0), Vec3(3, 1, 0), Vec3(3, 2, 0)});
    corners.push_back(corners[0]);
    const std::vector<double> areas = doubled_areas(triangles_of(corners));
    EXPECT_EQ(sum(areas), 14);
    EXPECT_GE(least(areas), 0);
    // Without any area.
    EXPECT_EQ(sum(doubled_areas(triangles_of(Corners(7, Vec3(1, 2, 3))))), 0);
}

TEST(Polygons, ThoseThatCrossThemselvesKeepTheirSignedArea) {
    // A bow of a large loop to the left and a small one to the right.
    const Corners corners = flat({{0, 0}, {4, 0}, {4, 4}, {-1, -1}, {-1, 0}, {0, -2}});
    double area = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = corners[i], b = corners[(i + 1) % corners.size()];
        area += double(a.x() * b.y() - a.y() * b.x());
    }
    EXPECT_EQ(sum(doubled_areas(triangles_of(corners))), area);
}

TEST(Polygons, ConvexOnesAreFansOfTheirFirstCorner) {
    // The rounding of a circle's corners to float must not count as a dent; nor must three on a line.
    for (const float far : {0.0f, 1000.0f}) {
        Corners corners;
        for (int i = 0; i < 500; ++i) {
            const double angle = 2 * 3.141592653589793 * i / 500;
            corners.emplace_back(far + float(std::cos(angle)), far + float(std::sin(angle)), far);
        }
        const MeshData mesh = triangles_of(corners);
        for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
            ASSERT_EQ(Eigen::RowVector3i(mesh.F.row(f)), Eigen::RowVector3i(0, int(f) + 1, int(f) + 2));
    }
}

/// A comb of long teeth.
Corners comb_of(size_t corners) {
    const size_t teeth = corners / 2 - 1;
    Corners comb = flat({{0, 0}, {float(2 * teeth), 0}});
    for (size_t i = teeth; i-- > 0;) {
        comb.emplace_back(float(2 * i + 1), 8.0f, 0.0f);
        comb.emplace_back(float(2 * i), 1.0f, 0.0f);
    }
    return comb;
}

/// A star whose points have lengths from a linear congruential generator (Numerical Recipes), from 1 to 11.
Corners star_of(size_t corners) {
    Corners star;
    uint32_t random = 1;
    for (size_t i = 0; i < corners; ++i) {
        random = 1664525 * random + 1013904223;
        const double angle = 2 * 3.141592653589793 * double(i) / double(corners);
        const double length = 1 + 10 * double(random) / 4294967296.0;
        star.emplace_back(float(length * std::cos(angle)), float(length * std::sin(angle)), 0.0f);
    }
    return star;
}

TEST(Polygons, AnyNumberOfCornersIsCut) {
    // Each area of the comb is a whole number.
    const Corners comb = comb_of(200000);
    const std::vector<double> of_comb = doubled_areas(triangles_of(comb));
    EXPECT_EQ(sum(of_comb), outline_area(comb));
    EXPECT_GE(least(of_comb), 0);
    const Corners star = star_of(100000);
    const std::vector<double> of_star = doubled_areas(triangles_of(star));
    // Products of up to 22 x 22 are rounded 2e5 times, and sums of up to 2 x pi x 11^2 1e5 times: by 2^-53.
    EXPECT_NEAR(sum(of_star), outline_area(star), 2e-8);
    EXPECT_GE(least(of_star), 0);
}

TEST(Polygons, TheSearchForEarsEndsWithAWarning) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const Corners spiral = spiral_of(1000);
    const MeshData exact = triangles_of(spiral), rough = triangles_of(spiral, {}, 1);
    set_log_sink({});
    EXPECT_GE(least(doubled_areas(exact)), 0);
    EXPECT_LT(least(doubled_areas(rough)), 0) << "one look for each corner is no search";
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("1 of 1 polygons"), std::string::npos) << warnings[0];
    // Radii are up to 91: sums of 1000 areas of up to 4 x 91^2, also of those turned over, are rounded 1000
    // times by 2^-53.
    EXPECT_NEAR(sum(doubled_areas(rough)), outline_area(spiral), 4e-6) << "the signed area stays";
}

TEST(Polygons, TheSearchForEarsCanBeInterrupted) {
    const Corners comb = comb_of(200000);
    const InterruptScope scope([] { return true; });
    EXPECT_THROW(triangles_of(comb), Interrupted);
}

TEST(Polygons, AllReadersCutThem) {
    std::string obj, rows;
    for (const auto& [x, y] : letter_u) {
        rows += std::to_string(x) + " " + std::to_string(y) + " 0\n";
        obj += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
    }
    const std::string face = "8 0 1 2 3 4 5 6 7\n";
    obj += "f 1 2 3 4 5 6 7 8\n";
    const std::string off = "OFF\n8 1 0\n" + rows + face;
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
        rows + face;
    for (const MeshData& mesh : {read_obj(Source(std::string_view(obj), "u.obj"), {}),
                                 read_off(Source(std::string_view(off), "u.off")),
                                 read_ply(Source(std::string_view(ply), "u.ply"))}) {
        EXPECT_EQ(sum(doubled_areas(mesh)), 14);
        EXPECT_GE(least(doubled_areas(mesh)), 0);
        EXPECT_TRUE((mesh.source_face.array() == 0).all());
    }
}

}  // namespace
}  // namespace easypbr::io::polygons_test
