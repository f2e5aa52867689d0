#include "easypbr/scene/normals.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <random>

#include "easypbr/core/error.h"
#include "easypbr/core/math.h"
#include "easypbr/geometry/primitives.h"

namespace easypbr::normals_test {
namespace {

double angle_deg(const Vec3& a, const Vec3& b) {
    return degrees(
        std::atan2(a.cast<double>().cross(b.cast<double>()).norm(), a.cast<double>().dot(b.cast<double>())));
}

/// A bumpy sheet of about 2 rows^2 triangles whose vertices are numbered at random.
struct Grid {
    Array3f V;
    Array3i F;
};
Grid shuffled_grid(int rows) {
    std::mt19937 random(7);
    std::vector<int> number(size_t(rows) * rows);
    for (size_t i = 0; i < number.size(); ++i) number[i] = int(i);
    std::shuffle(number.begin(), number.end(), random);
    Array3f::Dense V(Eigen::Index(number.size()), 3);
    Array3i::Dense F(2 * (rows - 1) * (rows - 1), 3);
    Eigen::Index face = 0;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < rows; ++x) {
            const auto at = [&](int i, int j) { return number[size_t(j) * rows + i]; };
            V.row(at(x, y)) << float(x), float(y), 3 * std::sin(float(x) * 0.7f) * std::cos(float(y) * 0.3f);
            if (x == rows - 1 || y == rows - 1) continue;
            F.row(face++) << at(x, y), at(x + 1, y), at(x + 1, y + 1);
            F.row(face++) << at(x, y), at(x + 1, y + 1), at(x, y + 1);
        }
    }
    return {V, F};
}

TEST(VertexNormals, OfASphereAreRadial) {
    // The seam's columns see half of their neighbours, and lean by about half a segment (1.4 degrees at 128).
    const auto sphere = make_sphere(2, 128).snapshot();
    const Array3f N = vertex_normals(sphere->V, sphere->F);
    double worst = 0, sum = 0;
    int inner = 0;
    for (Eigen::Index v = 0; v < N.rows(); ++v) {
        const Eigen::Index ring = v / 129, column = v % 129;
        if (ring == 0 || ring == 64 || column == 0 || column == 128) continue;
        const double error = angle_deg(N.row(v).transpose(), sphere->N.row(v).transpose());
        worst = std::max(worst, error);
        sum += error;
        ++inner;
    }
    // Error of second order in the segment's angle h = 0.049: h^2 / 8 is 0.017 degrees, more where triangles
    // are slender near the poles.
    EXPECT_LT(sum / inner, 0.03);
    EXPECT_LT(worst, 1.0);
}

TEST(VertexNormals, OfACubeAreItsDiagonals) {
    // Eight shared vertices. All triangles have the area 1/2, and a corner has 90 degrees of each of its
    // three sides, in one triangle or in two: the sum is along the diagonal. Tolerance: the arctangent, 1e-5,
    // on three angles.
    Array3f::Dense V(8, 3);
    for (int i = 0; i < 8; ++i) V.row(i) << float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1);
    Array3i::Dense F(12, 3);
    F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1,
        7, 5;
    const Array3f N = vertex_normals(V, F);
    for (int i = 0; i < 8; ++i) {
        const Vec3 diagonal = (V.row(i).transpose() - Vec3::Constant(0.5f)).normalized();
        EXPECT_LT((N.row(i).transpose() - diagonal).norm(), 3e-5f) << i;
    }
}

TEST(VertexNormals, WeighByAreaTimesAngle) {
    // Vertex 0 has a right-angled triangle with legs 1 and 1 in the plane z = 0 (area 1/2, 90 degrees), and
    // one with legs 2 and 2 in the plane x = 0 at 45 degrees (area 2 sin 45). Sum of area x angle, on paper:
    // (0, 0, 1) * 0.5 * pi/2 + (1, 0, 0) * 1.4142136 * pi/4. Tolerance: the arctangent, 2e-5 per angle.
    Array3f::Dense V(5, 3);
    const float r = std::sqrt(2.0f);
    V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, r, r;
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 3, 4;
    const Vec3d expected = Vec3d(std::sqrt(2.0) * pi / 4, 0, 0.5 * pi / 2).normalized();
    const Array3f N = vertex_normals(V, F);
    EXPECT_LT((N.row(0).transpose().cast<double>() - expected).norm(), 4e-5);
}

TEST(VertexNormals, OfAConeStandOnItsSide) {
    // Radius 1, height 1: the side's normal rises by 45 degrees. Base vertices between equal neighbours have
    // it exactly in their plane of symmetry; the polygon of 256 sides is flatter than the circle by less than
    // 1e-4.
    constexpr int sides = 256;
    Array3f::Dense V(sides + 1, 3);
    Array3i::Dense F(sides, 3);
    V.row(sides) << 0, 1, 0;
    for (int i = 0; i < sides; ++i) {
        const double phi = 2 * pi * i / sides;
        V.row(i) << float(std::sin(phi)), 0, float(std::cos(phi));
        F.row(i) << i, (i + 1) % sides, sides;
    }
    const Array3f N = vertex_normals(V, F);
    for (int i = 0; i < sides; ++i) {
        const Vec3 expected = Vec3(V(i, 0), 1, V(i, 2)).normalized();
        EXPECT_LT(angle_deg(N.row(i).transpose(), expected), 0.02);
    }
    EXPECT_LT(angle_deg(N.row(sides).transpose(), Vec3::UnitY()), 0.01);
}

TEST(VertexNormals, FacesWithoutAreaCountNothing) {
    Array3f::Dense V(5, 3);
    V << 0, 0, 0, 1, 0, 0, 0, 0, -1, 2, 0, 0, 9, 9, 9;
    Array3i::Dense F(4, 3);
    F << 0, 1, 2, 0, 1, 3, 0, 0, 0, 3, 3, 1;  // a good one, a line, a point, a line
    const Array3f N = vertex_normals(V, F);
    EXPECT_EQ(Vec3(N.row(0)), Vec3(0, 1, 0));
    EXPECT_EQ(Vec3(N.row(1)), Vec3(0, 1, 0));
    EXPECT_EQ(Vec3(N.row(3)), Vec3(0, 0, 1)) << "only degenerate faces";
    EXPECT_EQ(Vec3(N.row(4)), Vec3(0, 0, 1)) << "no face at all";
}

TEST(VertexNormals, NoVerticesAndNoFacesAreFine) {
    EXPECT_EQ(vertex_normals({}, {}).rows(), 0);
    EXPECT_EQ(vertex_normals(Array3f::Dense(Array3f::Dense::Zero(3, 3)), {}).row(2),
              Eigen::RowVector3f(0, 0, 1));
}

TEST(VertexNormals, IndicesOutOfRangeAreRefused) {
    const Array3f V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const int32_t index : {-1, 3, 99'999'999}) {
        const Array3i F = Array3i::Dense{{0, 1, 2}, {0, 1, index}};
        try {
            vertex_normals(V, F);
            ADD_FAILURE() << index;
        } catch (const ArgumentError& error) {
            EXPECT_EQ(error.what(), fmt::format("mesh array F: expected vertex indices from 0 to 2, got {} "
                                                "in row 1 of 2",
                                                index));
        }
        EXPECT_THROW(face_normals(V, F), ArgumentError) << index;
        MeshData mesh;
        mesh.V = V, mesh.F = F, mesh.source_vertex = Array1i::Dense{{0}, {1}, {0}};
        EXPECT_THROW(smooth_normals(mesh), ArgumentError) << index;
    }
}

TEST(VertexNormals, OfSplitVerticesDependOnNoNumber) {
    // Two faces at a right angle whose common edge is split: half way between both, by equal areas and
    // angles.
    MeshData mesh;
    mesh.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.F = Array3i::Dense{{0, 1, 2}, {3, 4, 5}};
    constexpr int32_t most = std::numeric_limits<int32_t>::max();
    for (const Array1i::Dense& source :
         {Array1i::Dense{{0, 1, 2, 0, 2, 3}}, Array1i::Dense{{7, 3, most, 7, most, most - 1}}}) {
        mesh.source_vertex = source;
        const Array3f N = smooth_normals(mesh);
        EXPECT_TRUE((N.row(0).array() == N.row(3).array()).all());
        EXPECT_TRUE((N.row(2).array() == N.row(4).array()).all());
        EXPECT_NEAR(N(0, 0), std::sqrt(0.5f), 1e-5f) << "angles: below 1e-5 by Abramowitz and Stegun 4.4.47";
        EXPECT_EQ(N(1, 2), 1);
        EXPECT_EQ(N(5, 0), 1);
    }
    mesh.source_vertex = Array1i::Dense{{0, 1, 2, 0, -2, 3}};
    EXPECT_THROW(smooth_normals(mesh), ArgumentError);
    mesh.source_vertex = Array1i::Dense{{0, 1, 2, 0}};
    EXPECT_THROW(smooth_normals(mesh), ArgumentError);
}

TEST(VertexNormals, DoNotDependOnTheNumberOfThreads) {
    // 500,000 faces: several slabs, and every vertex is added to from faces far apart.
    const Grid grid = shuffled_grid(500);
    Array3f one, several;
    tbb::task_arena(1).execute([&] { one = vertex_normals(grid.V, grid.F); });
    tbb::task_arena(2).execute([&] { several = vertex_normals(grid.V, grid.F); });
    EXPECT_TRUE((one.array() == several.array()).all());
    EXPECT_GT((one.rowwise().norm().array()).minCoeff(), 0.999f);
}

TEST(VertexNormals, DoNotChangeWithScale) {
    const Grid grid = shuffled_grid(60);
    const Array3f N = vertex_normals(grid.V, grid.F);
    for (const int exponent : {10, -10, 60, -60, -100}) {
        const Array3f::Dense scaled = grid.V * std::ldexp(1.0f, exponent);
        EXPECT_TRUE((vertex_normals(scaled, grid.F).array() == N.array()).all()) << "2^" << exponent;
    }
}

TEST(FaceNormals, AreUnitAndFollowTheWinding) {
    Array3f::Dense V(4, 3);
    V << 0, 0, 0, 1e-20f, 0, 0, 0, 1e-20f, 0, 0, 0, 0;
    Array3i::Dense F(3, 3);
    F << 0, 1, 2, 0, 2, 1, 0, 3, 1;
    const Array3f N = face_normals(V, F);
    EXPECT_EQ(Vec3(N.row(0)), Vec3(0, 0, 1));
    EXPECT_EQ(Vec3(N.row(1)), Vec3(0, 0, -1));
    EXPECT_EQ(Vec3(N.row(2)), Vec3(0, 0, 1)) << "no area";
}

}  // namespace
}  // namespace easypbr::normals_test
