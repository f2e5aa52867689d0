#include "easypbr/scene/crease.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/normals.h"

namespace easypbr::crease_test {

namespace {

/// A cube of 8 vertices and 12 triangles, two for each side.
MeshData cube() {
    MeshData mesh;
    Array3f::Dense V(8, 3);
    for (int i = 0; i < 8; ++i) V.row(i) << float(i & 1), float(i >> 1 & 1), float(i >> 2);
    mesh.V = std::move(V);
    mesh.F = Array3i::Dense{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

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

}  // namespace

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
