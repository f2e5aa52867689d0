// Polygons of OBJ and PLY files after they were read and written again.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "easypbr/core/file.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "io/temporary_folder.h"

namespace easypbr::polygon_writers_test {

namespace {

/// A bent quad, a bent pentagon, a dart, an L, a triangle beside the quad; each corner with its own place in
/// the texture. The fan from the L's first corner would not lie inside.
const char* const polygons_text =
    "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nv 0 1 0\n"
    "v 2 0 0\nv 3 0 0\nv 3.5 1 0.2\nv 2.5 2 0\nv 1.5 1 0\n"
    "v 4 0 0\nv 6 1 0\nv 4 2 0\nv 4.5 1 0\n"
    "v 9 0 0\nv 9 1 0\nv 8 1 0\nv 8 2 0\nv 7 2 0\nv 7 0 0\n"
    "v 2 0.5 1\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.25\nvt 0.75 0.5\n"
    "f 1/1 2/2 3/3 4/4\n"
    "f 5/1 6/2 7/3 8/4 9/5\n"
    "f 10/1 11/2 12/3 13/5\n"
    "f 14/1 15/2 16/3 17/4 18/5 19/6\n"
    "f 2/4 20/5 3/6\n";

/// Number of corners of each face of an OBJ file.
std::vector<int> face_sizes(const std::string& text) {
    std::vector<int> sizes;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("f ")) sizes.push_back(int(std::count(line.begin(), line.end(), ' ')));
    return sizes;
}

/// Position and texture coordinates of a corner.
using Corner = std::array<float, 5>;

/// For each triangle its polygon and its corners, from the smallest on; sorted, for a polygon's triangles
/// have no order.
std::vector<std::pair<int, std::array<Corner, 3>>> triangles_of(const MeshData& mesh) {
    std::vector<std::pair<int, std::array<Corner, 3>>> all;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
        std::array<Corner, 3> corners;
        for (int k = 0; k < 3; ++k) {
            const int v = mesh.F(f, k);
            corners[size_t(k)] = {mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2), mesh.UV(v, 0), mesh.UV(v, 1)};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.emplace_back(mesh.source_face(f), corners);
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Two triangles of one polygon between four vertices.
MeshData quad() {
    MeshData mesh;
    mesh.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5f}, {0, 1, 0}};
    mesh.F = Array3i::Dense{{0, 1, 2}, {2, 3, 0}};
    mesh.source_face = Array1i::Dense{{0}, {0}};
    return mesh;
}

std::string ply_text(const MeshData& mesh, const TemporaryFolder& folder) {
    Mesh(mesh).save(folder / "m.ply");
    return std::string(FileBytes(folder / "m.ply").text());
}

bool has_faces(const std::string& ply, int count) {
    return ply.find("element face " + std::to_string(count) + "\n") != ply.npos;
}

}  // namespace

TEST(PolygonWriters, KeepPolygonsOfAnyShape) {
    const TemporaryFolder folder;
    write_file(folder / "m.obj", std::string_view(polygons_text));
    const Mesh mesh(folder / "m.obj");
    const auto first = mesh.snapshot();
    ASSERT_EQ(first->F.rows(), 2 + 3 + 2 + 4 + 1);
    for (const char* name : {"again.obj", "again.ply"}) {
        mesh.save(folder / name);
        const auto again = Mesh(folder / name).snapshot();
        ASSERT_EQ(again->F.rows(), first->F.rows()) << name;
        ASSERT_EQ(again->source_face.rows(), first->F.rows()) << name;
        EXPECT_EQ(triangles_of(*again), triangles_of(*first)) << name;
    }
    const std::vector<int> sizes{4, 5, 4, 6, 3};
    EXPECT_EQ(face_sizes(std::string(FileBytes(folder / "again.obj").text())), sizes);
    EXPECT_TRUE(has_faces(std::string(FileBytes(folder / "again.ply").text()), 5));
}

TEST(PolygonWriters, KeepPolygonsOfParts) {
    const TemporaryFolder folder;
    MeshData mesh = quad();
    mesh.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5f}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    mesh.F = Array3i::Dense{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    mesh.source_face = Array1i::Dense{{0}, {0}, {1}, {1}};
    mesh.materials = {Material(), Material()};
    mesh.parts = {{"a", 0, 2, 0}, {"b", 2, 2, 1}};
    Mesh(mesh).save(folder / "m.obj");
    const std::string text(FileBytes(folder / "m.obj").text());
    EXPECT_EQ(face_sizes(text), (std::vector<int>{4, 4}));
    EXPECT_GT(text.rfind("usemtl"), text.find("f "));
    mesh.parts = {{"a", 0, 1, 0}, {"b", 1, 3, 1}};
    Mesh(mesh).save(folder / "m.obj");
    EXPECT_EQ(face_sizes(std::string(FileBytes(folder / "m.obj").text())), (std::vector<int>{3, 3, 4}))
        << "a polygon has one material";
}

TEST(PolygonWriters, KeepTrianglesThatAreNoPolygonExactly) {
    const TemporaryFolder folder;
    // Two squares at a right angle; no hexagon is cut into just their triangles.
    MeshData roof;
    roof.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, -1}, {1, 1, -1}};
    roof.F = Array3i::Dense{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    roof.source_face = Array1i::Dense{{0}, {0}, {0}, {0}};
    EXPECT_TRUE(has_faces(ply_text(roof, folder), 4));
    // Apart, turned against each other, closed, round a corner inside.
    MeshData apart = roof;
    apart.F = Array3i::Dense{{0, 1, 3}, {2, 4, 5}};
    apart.source_face = Array1i::Dense{{0}, {0}};
    EXPECT_TRUE(has_faces(ply_text(apart, folder), 2));
    MeshData turned = quad();
    turned.F = Array3i::Dense{{0, 1, 2}, {0, 3, 2}};
    EXPECT_TRUE(has_faces(ply_text(turned, folder), 2));
    MeshData closed = quad();
    closed.F = Array3i::Dense{{0, 1, 2}, {0, 2, 1}};
    EXPECT_TRUE(has_faces(ply_text(closed, folder), 2));
    MeshData star = roof;
    star.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0}, {9, 9, 9}};
    star.F = Array3i::Dense{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    EXPECT_TRUE(has_faces(ply_text(star, folder), 4));
    EXPECT_TRUE(has_faces(ply_text(quad(), folder), 1)) << "what the others differ from";
}

TEST(PolygonWriters, PolygonsHaveOneValue) {
    const TemporaryFolder folder;
    MeshData mesh = quad();
    mesh.L = Array1i::Dense{{7}, {7}};
    mesh.scalars = {{"area", Array1f(Array1f::Dense{{0.5f}, {0.5f}})}};
    EXPECT_TRUE(has_faces(ply_text(mesh, folder), 1));
    const auto again = Mesh(folder / "m.ply").snapshot();
    EXPECT_EQ(Array1i::Dense(again->L), (Array1i::Dense{{7}, {7}}));
    EXPECT_EQ(Array1f::Dense(again->scalars.at(0).values), (Array1f::Dense{{0.5f}, {0.5f}}));
    mesh.L = Array1i::Dense{{7}, {8}};
    EXPECT_TRUE(has_faces(ply_text(mesh, folder), 2));
    EXPECT_EQ(Array1i::Dense(Mesh(folder / "m.ply").L()), (Array1i::Dense{{7}, {8}}));
}

TEST(PolygonWriters, PolygonsOfMoreCornersThanAByteCounts) {
    const TemporaryFolder folder;
    constexpr int corners = 300;
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    write_file(folder / "m.obj", std::string_view(text + face + "\n"));
    const std::string ply = ply_text(*Mesh(folder / "m.obj").snapshot(), folder);
    EXPECT_TRUE(has_faces(ply, 1));
    EXPECT_NE(ply.find("property list int int vertex_indices\n"), ply.npos);
    EXPECT_EQ(Mesh(folder / "m.ply").F().rows(), corners - 2);
}

}  // namespace easypbr::polygon_writers_test
