// Cutting objects and making cubes of cells.
#include <gtest/gtest.h>

#include <set>

#include "easypbr/core/error.h"
#include "easypbr/scene/cut.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/voxels.h"

namespace easypbr::cut_test {
namespace {

const Eigen::Vector4d keep_positive_x(1, 0, 0, 0);

MeshData square() {
    Array3f::Dense V(4, 3);
    V << -1, -1, 0, 3, -1, 0, 3, 1, 0, -1, 1, 0;
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    ArrayXf::Dense C(4, 3);
    C << 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0;
    MeshData mesh;
    mesh.V = Array3f(V);
    mesh.F = Array3i(F);
    mesh.C = ArrayXf(C);
    return mesh;
}

double area(const MeshData& mesh) {
    double sum = 0;
    for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
        const Vec3 a = mesh.V.row(mesh.F(i, 0)), b = mesh.V.row(mesh.F(i, 1)), c = mesh.V.row(mesh.F(i, 2));
        sum += double((b - a).cross(c - a).norm()) / 2;
    }
    return sum;
}

TEST(Cut, LeavesWhatIsOnThePositiveSide) {
    Array1i source, vertices;
    const MeshData rest = cut(square(), {keep_positive_x}, false, source, vertices);
    EXPECT_NEAR(area(rest), 6, 1e-6);
    EXPECT_GE(rest.V.col(0).minCoeff(), 0);
    EXPECT_EQ(source.rows(), rest.F.rows());
    // The square's corners are at x = -1 and 3: where it is cut at 0 those at the left have the larger part.
    ASSERT_EQ(vertices.rows(), rest.V.rows());
    for (Eigen::Index i = 0; i < rest.V.rows(); ++i)
        EXPECT_EQ(square().V(vertices(i), 0), rest.V(i, 0) < 1 ? -1 : 3) << i;
    // Colour grows linearly from x = -1 to 3.
    for (Eigen::Index i = 0; i < rest.V.rows(); ++i) EXPECT_NEAR(rest.C(i, 0), (rest.V(i, 0) + 1) / 4, 1e-6);
    // The winding stays.
    for (Eigen::Index i = 0; i < rest.F.rows(); ++i) {
        const Vec3 a = rest.V.row(rest.F(i, 0)), b = rest.V.row(rest.F(i, 1)), c = rest.V.row(rest.F(i, 2));
        EXPECT_GT((b - a).cross(c - a).z(), 0);
    }
}

// At x >= 0 the corners 1 and 2 of the square are left, each as two vertices that were split from one.
TEST(Cut, KeepsWhichVerticesWereSplitFromOne) {
    MeshData mesh = square();
    const Array1i corners(Eigen::Map<const Eigen::VectorXi>(mesh.F.data(), 6));
    repeat_vertices({corners.data(), 6}, mesh);
    mesh.F = Array3i(Array3i::Dense{{0, 1, 2}, {3, 4, 5}});
    Array1i faces, vertices;
    const MeshData rest = cut(mesh, {keep_positive_x}, false, faces, vertices);
    ASSERT_EQ(rest.source_vertex.rows(), rest.V.rows());
    std::multiset<int32_t> whole;
    std::set<int32_t> made;
    for (Eigen::Index i = 0; i < rest.V.rows(); ++i)
        if (const int32_t source = rest.source_vertex(i); source < 4)
            whole.insert(source);
        else
            EXPECT_TRUE(made.insert(source).second) << "a vertex that the cut makes is none's";
    // The first triangle has the corners 0, 1, 2, the second 0, 2, 3.
    EXPECT_EQ(whole, (std::multiset<int32_t>{1, 2, 2}));
    EXPECT_NO_THROW(validate(rest));
}

TEST(Cut, ByABoxLeavesItsArea) {
    std::vector<Eigen::Vector4d> planes = {keep_positive_x, {-1, 0, 0, 1}, {0, 1, 0, 0.5}, {0, -1, 0, 0.25}};
    Array1i source, vertices;
    EXPECT_NEAR(area(cut(square(), planes, false, source, vertices)), 0.75, 1e-6);
    planes.emplace_back(0, 0, 1, -1);
    const MeshData nothing = cut(square(), planes, false, source, vertices);
    EXPECT_TRUE(nothing.F.empty());
    EXPECT_NO_THROW(validate(nothing));
}

TEST(Cut, KeepsWholePoints) {
    MeshData points = square();
    points.F = {};
    Array1i source, vertices;
    const MeshData rest = cut(points, {keep_positive_x}, true, source, vertices);
    ASSERT_EQ(rest.V.rows(), 2);
    EXPECT_EQ(vertices(0), 1);
    EXPECT_EQ(vertices(1), 2);
}

TEST(Cut, CutsEdges) {
    MeshData line = square();
    line.F = {};
    Array2i::Dense E(2, 2);
    E << 0, 1, 0, 3;
    line.E = Array2i(E);
    Array1i source, vertices;
    const MeshData rest = cut(line, {keep_positive_x}, false, source, vertices);
    ASSERT_EQ(rest.E.rows(), 1);
    EXPECT_NEAR((rest.V.row(rest.E(0, 0)) - rest.V.row(rest.E(0, 1))).norm(), 3, 1e-6);
}

TEST(Cut, KeepsParts) {
    MeshData mesh = square();
    mesh.materials.resize(2);
    mesh.parts = {{"a", 0, 1, 0}, {"b", 1, 1, 1}};
    Array1i source, vertices;
    const MeshData rest = cut(mesh, {keep_positive_x}, false, source, vertices);
    ASSERT_EQ(rest.parts.size(), 2u);
    EXPECT_EQ(rest.parts[0].face_count + rest.parts[1].face_count, rest.F.rows());
    EXPECT_NO_THROW(validate(rest));
}

MeshData centres(std::initializer_list<std::array<float, 3>> places) {
    Array3f::Dense V(Eigen::Index(places.size()), 3);
    Eigen::Index row = 0;
    for (const auto& p : places) V.row(row++) << p[0], p[1], p[2];
    MeshData mesh;
    mesh.V = Array3f(V);
    return mesh;
}

TEST(Voxels, HaveTheSidesThatCanBeSeen) {
    EXPECT_EQ(voxel_mesh(centres({{0, 0, 0}}), 1).F.rows(), 12);
    // Two that touch share no side, two that do not have all.
    EXPECT_EQ(voxel_mesh(centres({{0, 0, 0}, {1, 0, 0}}), 1).F.rows(), 20);
    EXPECT_EQ(voxel_mesh(centres({{0, 0, 0}, {2, 0, 0}}), 1).F.rows(), 24);
    // A cube of 3 x 3 x 3 cells has 9 squares on each of six sides.
    Array3f::Dense V(27, 3);
    for (int i = 0; i < 27; ++i) V.row(i) << float(i % 3), float(i / 3 % 3), float(i / 9);
    MeshData cube;
    cube.V = Array3f(V);
    const MeshData mesh = voxel_mesh(cube, 1);
    EXPECT_EQ(mesh.F.rows(), 6 * 9 * 2);
    EXPECT_NEAR(area(mesh), 54, 1e-4);
    EXPECT_NEAR(mesh.V.minCoeff(), -0.5f, 1e-6);
    EXPECT_NEAR(mesh.V.maxCoeff(), 2.5f, 1e-6);
}

TEST(Voxels, FaceOutward) {
    const MeshData mesh = voxel_mesh(centres({{0.25f, -3, 7}}), 0.5);
    const Vec3 centre(0.25f, -3, 7);
    for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
        const Vec3 a = mesh.V.row(mesh.F(i, 0)), b = mesh.V.row(mesh.F(i, 1)), c = mesh.V.row(mesh.F(i, 2));
        EXPECT_GT((b - a).cross(c - a).dot(a - centre), 0) << i;
    }
}

TEST(Voxels, TakeTheMeanColourOfACell) {
    MeshData cloud = centres({{0, 0, 0}, {0.1f, 0.1f, 0}, {5, 0, 0}});
    ArrayXf::Dense C(3, 3);
    C << 1, 0, 0, 0, 0, 1, 0, 1, 0;
    cloud.C = ArrayXf(C);
    const MeshData mesh = voxel_mesh(cloud, 1);
    ASSERT_EQ(mesh.F.rows(), 24);
    std::set<int> sources(mesh.source_face.begin(), mesh.source_face.end());
    EXPECT_EQ(sources, (std::set<int>{0, 2}));
    for (Eigen::Index i = 0; i < mesh.V.rows(); ++i)
        EXPECT_NEAR(mesh.C(i, 0), mesh.V(i, 0) < 2 ? 0.5f : 0.0f, 1e-6f);
}

TEST(Voxels, RefuseSizesThatMakeNoGrid) {
    EXPECT_THROW(voxel_mesh(centres({{0, 0, 0}}), 0), ArgumentError);
    EXPECT_THROW(voxel_mesh(centres({{0, 0, 0}}), -1), ArgumentError);
    EXPECT_THROW(voxel_mesh(centres({{0, 0, 0}, {1e6f, 0, 0}}), 0.01), ArgumentError);
    EXPECT_NO_THROW(voxel_mesh(MeshData{}, 1));
}

}  // namespace
}  // namespace easypbr::cut_test
