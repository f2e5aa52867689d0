#include "easypbr/scene/crease.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/normals.h"
#include "scene/cube_mesh.h"

namespace easypbr::crease_test {

namespace {

/// Two triangles with a common edge along y, the second turned down by an angle. At the edge each has
/// vertices of its own, as at a seam of texture coordinates.
MeshData folded(double angle_deg) {
    const auto x = float(std::cos(radians(angle_deg))), z = float(-std::sin(radians(angle_deg)));
    MeshData mesh;
    mesh.V = Array3f::Dense{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 0}, {x, 0, z}, {0, 1, 0}};
    mesh.F = Array3i::Dense{{0, 1, 2}, {3, 4, 5}};
    mesh.source_vertex = Array1i::Dense{{0}, {1}, {2}, {0}, {3}, {1}};
    return mesh;
}

/// A closed torus without seams: 100 x 50 quads, neighbours at 3.6 and 7.2 degrees at most.
MeshData torus() {
    constexpr int around = 100, across = 50;
    Array3f::Dense V(around * across, 3);
    Array3i::Dense F(2 * around * across, 3);
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double a = 2 * pi * i / around, b = 2 * pi * j / across, r = 1 + 0.4 * std::cos(b);
            const auto at = [&](int di, int dj) { return (i + di) % around * across + (j + dj) % across; };
            V.row(at(0, 0)) << float(r * std::cos(a)), float(r * std::sin(a)), float(0.4 * std::sin(b));
            F.row(2 * at(0, 0)) << at(0, 0), at(1, 0), at(1, 1);
            F.row(2 * at(0, 0) + 1) << at(0, 0), at(1, 1), at(0, 1);
        }
    MeshData mesh;
    mesh.V = std::move(V);
    mesh.F = std::move(F);
    return mesh;
}

/// The same with every seventh face wound the other way round.
MeshData partly_turned(const MeshData& whole) {
    Array3i::Dense F = whole.F;
    for (Eigen::Index f = 0; f < F.rows(); f += 7) std::swap(F(f, 1), F(f, 2));
    MeshData mesh = whole;
    mesh.F = std::move(F);
    return mesh;
}

}  // namespace

// Folded by 40 degrees at rest and by 80 now, at a crease angle of 60; and the other way round.
TEST(Creases, AMeshThatDeformsHasThoseAtRest) {
    for (const double at_rest : {40.0, 80.0}) {
        MeshData mesh = folded(120 - at_rest);
        EXPECT_EQ(find_creases(mesh, 60).empty(), at_rest > 60) << "as it is now";
        mesh.rest_shape = {folded(at_rest).V, mesh.F.revision()};
        EXPECT_EQ(find_creases(mesh, 60).empty(), at_rest < 60);
        mesh.F = Array3i::Dense(mesh.F);
        EXPECT_EQ(find_creases(mesh, 60).empty(), at_rest > 60) << "other faces";
    }
}

// What is drawn flat is written with the normals of the faces as they are: the fold is none at rest.
TEST(Creases, FlatFacesHaveTheNormalsOfTheirPose) {
    MeshData mesh = folded(90);
    mesh.rest_shape = {folded(0).V, mesh.F.revision()};
    mesh.style.flat = true;
    add_drawn_normals(mesh);
    // Rounding of cos and sin of the angle.
    EXPECT_LT((mesh.N.row(mesh.F(0, 0)) - Eigen::RowVector3f(0, 0, 1)).norm(), 1e-6f);
    EXPECT_LT((mesh.N.row(mesh.F(1, 0)) - Eigen::RowVector3f(1, 0, 0)).norm(), 1e-6f);
}

TEST(Creases, SplitTheCornersOfACube) {
    MeshData mesh = cube();
    mesh.L = Array1i::Dense{{0}, {0}, {1}, {1}, {2}, {2}, {3}, {3}, {4}, {4}, {5}, {5}};
    Array1f::Dense height(8);
    for (int i = 0; i < 8; ++i) height[i] = float(i);
    mesh.scalars = {{"height", Array1f(height)}};
    mesh.E = Array2i::Dense{{0, 7}};
    const MeshData before = mesh;
    const std::vector<int32_t> rows = split_creases(mesh, 30);
    EXPECT_NO_THROW(validate(mesh));
    ASSERT_EQ(mesh.V.rows(), 6 * 4) << "four for each side";
    ASSERT_EQ(rows.size(), 24u);
    for (Eigen::Index i = 0; i < 24; ++i) {
        EXPECT_EQ(mesh.V.row(i), before.V.row(rows[size_t(i)]));
        EXPECT_EQ(mesh.scalars[0].values(i), float(rows[size_t(i)]));
    }
    const Array3f sides = face_normals(before.V, before.F);
    for (Eigen::Index f = 0; f < 12; ++f)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(rows[size_t(mesh.F(f, k))], before.F(f, k));
            // Sums of multiples of one unit vector along an axis, normalised: exact.
            EXPECT_EQ(mesh.N.row(mesh.F(f, k)), sides.row(f));
        }
    EXPECT_EQ(Array1i::Dense(mesh.L), Array1i::Dense(before.L)) << "those of faces stay";
    EXPECT_EQ(rows[size_t(mesh.E(0, 0))], 0);
    EXPECT_EQ(rows[size_t(mesh.E(0, 1))], 7);
}

TEST(Creases, VerticesSplitFromOneCountAsOne) {
    for (const double fold : {20.0, 40.0}) {
        MeshData mesh = folded(fold);
        split_creases(mesh, 30);
        ASSERT_EQ(mesh.V.rows(), 6) << "each vertex is in one face";
        const float across = mesh.N.row(mesh.F(0, 0)).dot(mesh.N.row(mesh.F(1, 0)));
        // Soft: the same normal, which is copied; sharp: the faces' own, to a few roundings.
        EXPECT_NEAR(across, fold < 30 ? 1 : std::cos(radians(fold)), 1e-6) << fold;
    }
}

TEST(Creases, OfASmoothMeshAreNone) {
    const MeshData whole = torus();
    MeshData mesh = whole;
    EXPECT_TRUE(find_creases(mesh, 60).empty());
    const std::vector<int32_t> rows = split_creases(mesh, 60);
    EXPECT_EQ(mesh.V.revision(), whole.V.revision());
    EXPECT_EQ(mesh.F.revision(), whole.F.revision());
    EXPECT_TRUE(mesh.source_vertex.empty());
    EXPECT_TRUE((mesh.N.array() == vertex_normals(whole.V, whole.F).array()).all());
    ASSERT_EQ(rows.size(), size_t(whole.V.rows()));
    EXPECT_EQ(rows.back(), int32_t(rows.size()) - 1);
}

TEST(Creases, NoiseOfAScanIsSmooth) {
    // Heights within 0.1 of the plane at distances of 1: slopes up to 0.2 along both axes, faces up to
    // atan(0.2 sqrt(2)) = 15.8 degrees from the plane, and so 31.6 degrees from each other.
    constexpr int side = 60;
    Array3f::Dense V(side * side, 3);
    uint32_t state = 1;
    for (int i = 0; i < side * side; ++i) {
        state = state * 1664525u + 1013904223u;
        V.row(i) << float(i % side), float(i / side), 0.2f * float(state >> 8) / float(1 << 24) - 0.1f;
    }
    std::vector<Eigen::RowVector3i> faces;
    for (int y = 0; y + 1 < side; ++y)
        for (int x = 0; x + 1 < side; ++x) {
            const int i = y * side + x;
            faces.emplace_back(i, i + 1, i + side);
            faces.emplace_back(i + 1, i + side + 1, i + side);
        }
    Array3i::Dense F(Eigen::Index(faces.size()), 3);
    for (size_t f = 0; f < faces.size(); ++f) F.row(Eigen::Index(f)) = faces[f];
    MeshData mesh;
    mesh.V = std::move(V);
    mesh.F = std::move(F);
    EXPECT_TRUE(find_creases(mesh, 60).empty());
}

TEST(Creases, AFaceWoundTheWrongWayHasItsOwnSide) {
    MeshData mesh = cube();
    Array3i::Dense F = mesh.F;
    std::swap(F(0, 1), F(0, 2));
    mesh.F = std::move(F);
    const MeshData before = mesh;
    split_creases(mesh, 60);
    EXPECT_NO_THROW(validate(mesh));
    EXPECT_EQ(mesh.V.rows(), 6 * 4 + 2) << "the two vertices where the halves of its side meet, once more";
    const Array3f sides = face_normals(before.V, before.F);
    for (Eigen::Index f = 0; f < 12; ++f)
        // Sums of multiples of one unit vector along an axis, normalised: exact.
        for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.N.row(mesh.F(f, k)), sides.row(f)) << f;
}

TEST(Creases, FacesWoundAgainstEachOtherHaveOneNormalAndItsOpposite) {
    const MeshData whole = torus();
    const Array3f N = vertex_normals(whole.V, whole.F);
    Array3i::Dense both(2 * whole.F.rows(), 3);
    both.topRows(whole.F.rows()) = whole.F;
    for (int k = 0; k < 3; ++k) both.col(k).tail(whole.F.rows()) = whole.F.col(2 - k);
    MeshData doubled = whole;
    doubled.F = std::move(both);
    for (const float angle : {60.0f, 180.0f})
        for (const MeshData& given : {partly_turned(whole), doubled}) {
            MeshData mesh = given;
            const std::vector<int32_t> rows = split_creases(mesh, angle);
            EXPECT_NO_THROW(validate(mesh));
            const Array3f faces = face_normals(given.V, given.F);
            double worst = 1;
            for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
                for (int k = 0; k < 3; ++k) {
                    const int32_t row = mesh.F(f, k);
                    ASSERT_EQ(rows[size_t(row)], given.F(f, k));
                    const float smooth = mesh.N.row(row).dot(N.row(rows[size_t(row)]));
                    worst = std::min(worst, std::abs(double(smooth)));
                    ASSERT_GT(mesh.N.row(row).dot(faces.row(f)), 0) << "the side that the winding tells";
                }
            // The same sums in another order: a few roundings of 6e-8.
            EXPECT_GT(worst, 1 - 2e-6) << angle;
        }
}

TEST(Creases, FacesFoldedOntoEachOtherShareNoNormal) {
    for (const float angle : {60.0f, 180.0f}) {
        MeshData mesh;
        mesh.V = Array3f::Dense{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        mesh.F = Array3i::Dense{{0, 1, 2}, {0, 2, 1}};
        split_creases(mesh, angle);
        ASSERT_EQ(mesh.V.rows(), 6);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(Vec3(mesh.N.row(mesh.F(0, k))), Vec3(1, 0, 0));
            EXPECT_EQ(Vec3(mesh.N.row(mesh.F(1, k))), Vec3(-1, 0, 0));
        }
    }
}

TEST(Creases, DoNotDependOnTheNumberOfThreads) {
    const MeshData given = partly_turned(torus());
    MeshData one = given, several = given;
    tbb::task_arena(1).execute([&] { split_creases(one, 60); });
    tbb::task_arena(4).execute([&] { split_creases(several, 60); });
    EXPECT_TRUE((one.F.array() == several.F.array()).all());
    EXPECT_TRUE((one.N.array() == several.N.array()).all());
}

TEST(Creases, HoldForOtherPositions) {
    const Creases creases = find_creases(cube(), 60);
    MeshData mesh = cube();
    // Sheared by 70 degrees: edges at 20 degrees stay sharp, too.
    Array3f::Dense V = mesh.V;
    V.col(0) += std::tan(float(radians(70.0))) * mesh.V.col(2);
    mesh.V = std::move(V);
    const Array3f faces = face_normals(mesh.V, mesh.F);
    split_creases(mesh, creases);
    ASSERT_EQ(mesh.V.rows(), 24);
    for (Eigen::Index f = 0; f < 12; ++f)
        // Both halves of a parallelogram have the same normal, to a few roundings.
        for (int k = 0; k < 3; ++k) EXPECT_GT(mesh.N.row(mesh.F(f, k)).dot(faces.row(f)), 1 - 1e-6f) << f;
}

TEST(Creases, DrawnNormalsKeepTangentsWhereNothingIsSplit) {
    MeshData soft = folded(20), sharp = folded(70);
    soft.uv_tangents = sharp.uv_tangents = Array4f::Dense(Array4f::Dense::Constant(6, 4, 1));
    add_drawn_normals(soft);
    add_drawn_normals(sharp);
    EXPECT_EQ(soft.uv_tangents.rows(), 6);
    EXPECT_EQ(soft.N.row(soft.F(0, 0)), soft.N.row(soft.F(1, 0)));
    EXPECT_TRUE(sharp.uv_tangents.empty());
    EXPECT_EQ(sharp.N.row(sharp.F(0, 0)), Eigen::RowVector3f(0, 0, 1));
    // What is drawn flat has the faces' own.
    MeshData flat = folded(20);
    flat.style.flat = true;
    add_drawn_normals(flat);
    EXPECT_EQ(flat.N.row(flat.F(0, 0)), Eigen::RowVector3f(0, 0, 1));
}

TEST(Creases, OnlyMissingNormalsAreFilledIn) {
    MeshData mesh = cube();
    Array3f::Dense N = Array3f::Dense::Zero(8, 3);
    const Eigen::RowVector3f own = Eigen::RowVector3f(0.6f, 0, 0.8f);
    N.row(0) = own;
    mesh.N = N;
    Array1f::Dense height(8);
    for (int i = 0; i < 8; ++i) height[i] = float(i);
    mesh.scalars = {{"height", Array1f(height)}, {"side", Array1f(Array1f::Dense::LinSpaced(12, 0, 11))}};
    const MeshData before = mesh;
    fill_normals(mesh, 60);
    EXPECT_NO_THROW(validate(mesh));
    ASSERT_EQ(mesh.V.rows(), 1 + 7 * 3) << "one for each side but at the vertex that has a normal";
    const Array3f sides = face_normals(before.V, before.F);
    for (Eigen::Index f = 0; f < 12; ++f)
        for (int k = 0; k < 3; ++k) {
            const int32_t v = mesh.F(f, k), source = before.F(f, k);
            EXPECT_EQ(mesh.V.row(v), before.V.row(source));
            EXPECT_EQ(mesh.scalars[0].values(v), float(source));
            // Those of sides are multiples of one unit vector along an axis, normalised: exact.
            EXPECT_EQ(mesh.N.row(v), source == 0 ? own : Eigen::RowVector3f(sides.row(f)));
        }
    EXPECT_EQ(mesh.scalars[1].values, before.scalars[1].values) << "those of faces stay";
}

TEST(Creases, OfAMeshAndItsChildrenWithoutNormals) {
    Mesh root(cube()), flat(cube()), smooth(cube());
    flat.edit([](MeshData& data) { data.style.flat = true; });
    smooth.edit([](MeshData& data) { data.N = vertex_normals(data.V, data.F); });
    root.add_child(flat);
    root.add_child(smooth);
    split_creases(root, 30);
    EXPECT_EQ(root.V().rows(), 24);
    EXPECT_EQ(flat.V().rows(), 8);
    EXPECT_EQ(smooth.V().rows(), 8);
}

}  // namespace easypbr::crease_test
