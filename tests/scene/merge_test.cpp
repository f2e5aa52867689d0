#include "easypbr/scene/merge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "easypbr/core/color.h"
#include "easypbr/core/log.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/normals.h"
#include "scene/cube_mesh.h"

namespace easypbr::merge_test {
namespace {

using Rows3 = Array3f::Dense;

MeshData triangle(const std::string& name = "triangle") {
    MeshData data;
    data.name = name;
    data.V = Rows3{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.F = Array3i::Dense{{0, 1, 2}};
    return data;
}

Eigen::Affine3d linear(const Mat3d& M) {
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.linear() = M;
    return T;
}

Vec3 face_normal(const MeshData& mesh) {
    const auto corner = [&](int k) -> Vec3 { return mesh.V.row(mesh.F(0, k)).transpose(); };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
}

TEST(Transformed, MovesPositionsAndKeepsNormalsPerpendicular) {
    MeshData slope;
    slope.V = Rows3{{0, 0, 0}, {1, 1, 0}, {0, 0, 1}};
    slope.F = Array3i::Dense{{0, 2, 1}};
    slope.N = Rows3(Vec3(-1, 1, 0).normalized().transpose().replicate(3, 1));
    const MeshData stretched =
        transformed(slope, Eigen::Translation3d(5, 0, 0) * Eigen::Scaling(3.0, 1.0, 1.0));
    EXPECT_EQ(Vec3(stretched.V.row(1)), Vec3(8, 1, 0));
    // The plane y = x becomes y = x / 3, whose normal is (-1, 3, 0) / sqrt(10).
    EXPECT_LT((Vec3(stretched.N.row(0)) - Vec3(-1, 3, 0) / std::sqrt(10.0f)).norm(), 1e-6f);
    EXPECT_LT((face_normal(stretched) - Vec3(stretched.N.row(0))).norm(), 1e-6f);
}

TEST(Transformed, MirroringTurnsTheWinding) {
    MeshData mesh = triangle();
    mesh.N = Rows3(Vec3::UnitZ().transpose().replicate(3, 1));
    const MeshData mirrored = transformed(mesh, linear(Eigen::Vector3d(1, 1, -1).asDiagonal()));
    EXPECT_EQ(Vec3(mirrored.N.row(0)), Vec3(0, 0, -1));
    EXPECT_EQ(face_normal(mirrored), Vec3(0, 0, -1));
    // Mirroring within the plane leaves it facing the same way.
    const MeshData turned = transformed(mesh, linear(Eigen::Vector3d(-1, 1, 1).asDiagonal()));
    EXPECT_EQ(face_normal(turned), Vec3(0, 0, 1));
    EXPECT_EQ(Vec3(turned.N.row(0)), Vec3(0, 0, 1));
}

TEST(Transformed, WhatIsFlattenedKeepsFiniteNormals) {
    MeshData mesh = triangle();
    mesh.N = Rows3{{0, 0, 1}, {1, 0, 0}, {0, 0, 0}};
    const MeshData flat = transformed(mesh, linear(Eigen::Vector3d(1, 1, 0).asDiagonal()));
    EXPECT_EQ(Vec3(flat.N.row(0)), Vec3(0, 0, 1));
    EXPECT_EQ(Vec3(flat.N.row(1)), Vec3(0, 0, 1)) << "no direction is left";
    EXPECT_EQ(Vec3(flat.N.row(2)), Vec3(0, 0, 0)) << "no normal stays no normal";
}

TEST(Transformed, SurfelsBecomeTheEllipsesOfTheirImage) {
    MeshData surfel;
    surfel.V = Rows3{{0, 0, 0}};
    surfel.N = Rows3{{0, 0, 1}};
    surfel.T = Rows3{{1, 0, 0}};
    surfel.B = Array1f::Dense::Constant(1, 1.0f);
    Mat3d shear = Mat3d::Identity();
    shear(0, 1) = 1;
    const MeshData sheared = transformed(surfel, linear(shear));
    // The singular values of ((1, 1), (0, 1)) are the golden ratio and its reciprocal.
    const float golden = std::numbers::phi_v<float>;
    EXPECT_NEAR(std::max(sheared.T.row(0).norm(), sheared.B[0]), golden, 1e-6f);
    EXPECT_NEAR(std::min(sheared.T.row(0).norm(), sheared.B[0]), 1 / golden, 1e-6f);
    EXPECT_NEAR(sheared.T(0, 2), 0, 1e-7f);
    // A stretched one keeps its axes, whichever is the longer.
    const MeshData stretched = transformed(surfel, linear(Eigen::Vector3d(2, 3, 4).asDiagonal()));
    EXPECT_EQ(Vec3(stretched.T.row(0)), Vec3(2, 0, 0));
    EXPECT_EQ(stretched.B[0], 3);
}

TEST(Transformed, VoxelsKeepTheirVolumesFactor) {
    MeshData voxels;
    voxels.V = Rows3{{1, 1, 1}};
    voxels.voxel_size = 0.5f;
    EXPECT_FLOAT_EQ(transformed(voxels, linear(Mat3d::Identity() * 4)).voxel_size, 2);
}

TEST(Merged, CountsOnThroughFacesEdgesPartsAndMaterials) {
    MeshData a = triangle("a"), b = triangle("b");
    a.E = Array2i::Dense{{0, 1}};
    b.E = Array2i::Dense{{1, 2}};
    b.materials.resize(2);
    b.materials[1].roughness = 0.125f;
    b.parts = {{"wing", 0, 1, 1}};
    const MeshData both = merged(std::vector{a, b});
    EXPECT_NO_THROW(validate(both));
    EXPECT_EQ(both.name, "a");
    EXPECT_EQ(Array3i::Dense(both.F), (Array3i::Dense{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(Array2i::Dense(both.E), (Array2i::Dense{{0, 1}, {4, 5}}));
    ASSERT_EQ(both.parts.size(), 2u);
    EXPECT_EQ(both.parts[0].name, "a");
    EXPECT_EQ(both.parts[1].name, "wing");
    EXPECT_EQ(both.parts[1].first_face, 1);
    EXPECT_EQ(both.materials.at(size_t(both.parts[1].material)).roughness, 0.125f);
}

// Equal values and the same textures are one material; names are values.
TEST(Merged, JoinsEqualMaterials) {
    const auto image = std::make_shared<const Image>(1, 1, 3, PixelType::u8),
               copy = std::make_shared<const Image>(*image);
    Material rough, named, textured, other_image, mirrored;
    rough.roughness = 0.125f;
    named.name = "steel";
    textured.normal_texture.image = image;
    other_image.normal_texture.image = copy;
    mirrored = textured;
    mirrored.normal_texture.wrap_u = Wrap::mirror;
    const std::vector<Material> different{Material(), rough, named, textured, other_image, mirrored};
    MeshData a = triangle("a"), b = triangle("b"), none = triangle("none");
    a.materials = different;
    a.parts = {{"a", 0, 1, 1}};
    b.materials = {textured, rough, mirrored, textured};
    b.parts = {{"b", 0, 1, 3}};
    const MeshData whole = merged(std::vector{a, b, none, b});
    EXPECT_NO_THROW(validate(whole));
    EXPECT_EQ(whole.materials, different);
    ASSERT_EQ(whole.parts.size(), 4u);
    const int expected[] = {1, 3, 0, 3};
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(whole.parts[i].material, expected[i]) << i;
}

TEST(Merged, FillsInWhatOnlySomeHave) {
    MeshData a = triangle(), b = triangle();
    a.C = ArrayXf(ArrayXf::Dense::Constant(3, 4, 0.25f));
    a.UV = Array2f(Array2f::Dense::Constant(3, 2, 0.5f));
    a.L = Array1i(Array1i::Dense::Constant(3, 7));
    a.I = Array1f(Array1f::Dense::Constant(3, 2.0f));
    a.scalars = {{"height", Array1f(Array1f::Dense::Constant(3, 1.0f))}};
    a.N = Rows3(Rows3::Constant(3, 3, 0.5f));
    b.C = ArrayXf(ArrayXf::Dense::Constant(3, 3, 0.75f));
    const MeshData both = merged(std::vector{b, a, triangle()});
    EXPECT_NO_THROW(validate(both));
    EXPECT_EQ(Eigen::Vector4f(both.C.row(0)), Eigen::Vector4f(0.75f, 0.75f, 0.75f, 1)) << "no alpha: opaque";
    EXPECT_EQ(Eigen::Vector4f(both.C.row(3)), Eigen::Vector4f::Constant(0.25f));
    // The default material, which is white beside colours, leaves its grey to those.
    const float grey = srgb_from_linear(0.6f);
    EXPECT_EQ(Eigen::Vector4f(both.C.row(6)), Eigen::Vector4f(grey, grey, grey, 1));
    EXPECT_EQ(Vec3(both.N.row(0)), Vec3(0, 0, 1)) << "computed from the face";
    EXPECT_EQ(Vec3(both.N.row(3)), Vec3(0.5f, 0.5f, 0.5f));
    EXPECT_EQ(both.UV(0, 0), 0);
    EXPECT_EQ(both.L[0], no_label);
    EXPECT_EQ(both.L[5], 7);
    EXPECT_EQ(both.I[4], 2);
    EXPECT_TRUE(std::isnan(both.scalars.at(0).values[0]));
    EXPECT_EQ(both.scalars[0].values[3], 1);
}

MeshData triangle_with_normals() {
    MeshData mesh = triangle();
    mesh.N = Rows3(Vec3::UnitZ().transpose().replicate(3, 1));
    return mesh;
}

TEST(Merged, MeshesWithoutNormalsKeepTheirSharpEdges) {
    MeshData box = cube(), other = triangle_with_normals();
    box.L = Array1i(Array1i::Dense::LinSpaced(12, 0, 11));
    box.I = Array1f(Array1f::Dense::LinSpaced(8, 0, 7));
    other.E = Array2i::Dense{{0, 2}};
    const MeshData whole = merged(std::vector{box, other});
    EXPECT_NO_THROW(validate(whole));
    // Three normals at each corner of the cube: two more rows for each, behind those of both meshes.
    ASSERT_EQ(whole.V.rows(), 8 + 3 + 16);
    EXPECT_EQ(Rows3(whole.V.topRows(8)), Rows3(box.V));
    EXPECT_EQ(Rows3(whole.V.middleRows(8, 3)), Rows3(other.V));
    EXPECT_EQ(Array2i::Dense(whole.E), (Array2i::Dense{{8, 10}}));
    EXPECT_EQ(Eigen::RowVector3i(whole.F.row(12)), Eigen::RowVector3i(8, 9, 10));
    const Array3f sides = face_normals(box.V, box.F);
    for (Eigen::Index f = 0; f < 12; ++f)
        for (int k = 0; k < 3; ++k) {
            const int32_t v = whole.F(f, k), source = box.F(f, k);
            // Multiples of one unit vector along an axis, normalised: exact.
            EXPECT_EQ(Vec3(whole.N.row(v)), Vec3(sides.row(f)));
            EXPECT_EQ(Vec3(whole.V.row(v)), Vec3(box.V.row(source)));
            EXPECT_EQ(whole.I[v], float(source));
            EXPECT_EQ(whole.source_vertex[v], whole.source_vertex[source]);
        }
    ASSERT_EQ(whole.L.rows(), 13) << "those of faces stay so";
    EXPECT_EQ(whole.L[11], 11);
    EXPECT_EQ(whole.L[12], no_label);
    EXPECT_TRUE(merged(std::vector{box, triangle()}).N.empty()) << "none has normals: none needs them";
}

TEST(Merged, ValuesOfFacesStayThoseOfFaces) {
    MeshData a = cube(), b = cube();
    a.L = Array1i(Array1i::Dense::Constant(12, 1));
    // Two cubes of 8 vertices and 12 faces, and 8 points: as many vertices as faces.
    MeshData points;
    points.V = Rows3(Rows3::Zero(8, 3));
    const MeshData whole = merged(std::vector{a, b, points});
    ASSERT_EQ(whole.F.rows(), 24);
    EXPECT_EQ(whole.L.rows(), 24);
    EXPECT_EQ(element_of(whole, 24), PerElement::face) << "24 vertices would take the labels for theirs";
}

TEST(Merged, PointsWithoutNormalsGetNone) {
    MeshData points;
    points.V = Rows3{{0, 0, 0}};
    MeshData mesh = triangle();
    mesh.N = Rows3(Vec3::UnitZ().transpose().replicate(3, 1));
    EXPECT_EQ(Vec3(merged(std::vector{mesh, points}).N.row(3)), Vec3(0, 0, 0));
}

TEST(Merged, KeepsSurfelsAndVoxelsOnlyWhenAllAreSuch) {
    MeshData surfel;
    surfel.V = surfel.N = surfel.T = Rows3{{0, 0, 1}};
    surfel.B = Array1f::Dense::Constant(1, 1.0f);
    MeshData point;
    point.V = Rows3{{0, 0, 0}};
    EXPECT_EQ(merged(std::vector{surfel, surfel}).T.rows(), 2);
    EXPECT_EQ(merged(std::vector{surfel, surfel, MeshData{}}).B.rows(), 2) << "an empty mesh counts nothing";
    EXPECT_TRUE(merged(std::vector{surfel, point}).T.empty());
    EXPECT_TRUE(merged(std::vector{surfel, point}).B.empty());
    MeshData voxel = point;
    voxel.voxel_size = 2;
    EXPECT_EQ(merged(std::vector{voxel, voxel}).voxel_size, 2);
    EXPECT_EQ(merged(std::vector{voxel, point}).voxel_size, 0);
}

TEST(Merged, SourcesOfDifferentMeshesStayDifferent) {
    MeshData split = triangle();
    split.source_vertex = Array1i::Dense{{5, 0, 5}};
    const MeshData both = merged(std::vector{split, triangle(), split});
    EXPECT_EQ(Array1i::Dense(both.source_vertex), (Array1i::Dense{{5, 0, 5, 6, 7, 8, 14, 9, 14}}));
    // Numbers for which 32 bits would not do are counted anew.
    constexpr int32_t most = std::numeric_limits<int32_t>::max();
    split.source_vertex = Array1i::Dense{{most, 0, most}};
    const MeshData far = merged(std::vector{split, triangle(), split});
    EXPECT_EQ(Array1i::Dense(far.source_vertex), (Array1i::Dense{{1, 0, 1, 2, 3, 4, 6, 5, 6}}));
}

TEST(Merged, LabelsOfFacesAndOfVerticesDoNotMix) {
    MeshData of_vertices = triangle("first"), of_faces = triangle("second");
    of_vertices.L = Array1i(Array1i::Dense::Constant(3, 1));
    of_faces.L = Array1i(Array1i::Dense::Constant(1, 2));
    std::string warning;
    set_log_sink([&](LogLevel, std::string_view text) { warning = text; });
    const MeshData both = merged(std::vector{of_vertices, of_faces});
    set_log_sink(nullptr);
    EXPECT_EQ(Array1i::Dense(both.L), (Array1i::Dense{{1, 1, 1, no_label, no_label, no_label}}));
    EXPECT_NE(warning.find("'second'"), std::string::npos) << warning;
}

TEST(Flatten, BringsDescendantsIntoTheFrameOfTheParent) {
    Mesh root(triangle("root")), child(triangle("child"));
    root.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Scaling(2.0)));
    root.add_child(child);
    const MeshData flat = flatten(root);
    EXPECT_EQ(Vec3(flat.V.row(4)), Vec3(2, 0, 1));
    EXPECT_TRUE(flat.children.empty());
    EXPECT_TRUE(flat.T_parent_mesh.matrix().isIdentity(0));
    EXPECT_EQ(flat.name, "root");
    const Mesh alone(triangle());
    EXPECT_EQ(flatten(alone).V.data(), alone.V().data()) << "nothing to move: the same array";
}

// A fold of 45 degrees is drawn smooth; the pose makes it one of atan(3) = 72 degrees.
TEST(Flatten, EdgesAreAsSharpAsBeforeThePose) {
    const float part = std::sqrt(0.5f);
    MeshData fold;
    fold.V = Rows3{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {part, 0, -part}};
    fold.F = Array3i::Dense{{0, 1, 2}, {0, 3, 1}};
    Mesh root(fold);
    root.set_T_parent_mesh(linear(Eigen::Vector3d(1, 1, 3).asDiagonal()));
    root.add_child(Mesh(triangle_with_normals()));
    EXPECT_EQ(flatten(root).V.rows(), 4 + 3);
}

TEST(Flatten, AShapeRepeatsNoVertices) {
    Mesh root(cube());
    root.add_child(Mesh(triangle_with_normals()));
    EXPECT_EQ(flatten(root).V.rows(), 8 + 3 + 16);
    const MeshData shape = flatten_shape(root);
    EXPECT_EQ(shape.V.rows(), 8 + 3);
    EXPECT_EQ(shape.F.rows(), 12 + 1);
    EXPECT_TRUE(shape.N.empty());
}

// A pose holds what float32 cannot: 5,400,000.25 has spacings of half a metre there.
TEST(Flatten, GetsAnOffsetWherePosesMoveFarAway) {
    const Vec3d far(500000.125, 5400000.25, 312);
    Mesh root, child(triangle("child"));
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(far)));
    root.add_child(child);
    const MeshData flat = flatten(root);
    for (int i = 0; i < 3; ++i) {
        const Vec3d wanted = far + child.V().row(i).transpose().cast<double>();
        // V stays within 4 of zero, where float32 numbers are 2^-22 apart at most: half of it.
        EXPECT_LE((flat.offset + flat.V.row(i).transpose().cast<double>() - wanted).cwiseAbs().maxCoeff(),
                  std::exp2(-23.0));
    }
    EXPECT_LT(flat.V.cwiseAbs().maxCoeff(), 4);
    // What is near keeps its bits, and so do float32 arrays that nothing moves.
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(1000, 0, 0)));
    EXPECT_EQ(flatten(root).offset, Vec3d::Zero());
    MeshData still = triangle();
    still.V = Rows3{{5e6f, 0, 0}, {5e6f + 1, 0, 0}, {5e6f, 1, 0}};
    EXPECT_EQ(flatten(Mesh(still)).offset, Vec3d::Zero());
}

TEST(Flatten, LosesAnOffsetThatAPoseTakesBack) {
    MeshData data = triangle();
    data.offset = Vec3d(500000, 5400000, 312);
    Mesh mesh(data);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-data.offset)));
    const MeshData flat = flatten(mesh);
    EXPECT_LT(flat.offset.norm() + flat.V.cwiseAbs().maxCoeff(), 10);
}

}  // namespace
TEST(Merged, ColorsOfOthersLeaveGivenMaterialsAlone) {
    MeshData colored = triangle(), painted = triangle();
    colored.C = ArrayXf(ArrayXf::Dense::Constant(3, 3, 0.25f));
    painted.materials.resize(1);
    painted.materials[0].base_color = Vec3(0, 1, 0);
    EXPECT_EQ(Vec3(merged(std::vector{colored, painted}).C.row(3)), Vec3(1, 1, 1)) << "times its green";
    painted.materials[0] = {};
    painted.materials[0].base_color_given = true;
    EXPECT_EQ(Vec3(merged(std::vector{colored, painted}).C.row(3)), Vec3(1, 1, 1)) << "times its own grey";
    painted.materials[0].base_color_given = false;
    painted.materials[0].base_color_texture.image = std::make_shared<const Image>(1, 1, 3, PixelType::u8);
    painted.UV = Array2f(Array2f::Dense::Zero(3, 2));
    EXPECT_EQ(Vec3(merged(std::vector{colored, painted}).C.row(3)), Vec3(1, 1, 1)) << "its texture's own";
}

}  // namespace easypbr::merge_test
