#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/random_mesh.h"
#include "io/same_bits.h"
#include "io/temporary_folder.h"

namespace easypbr::mesh_roundtrip_test {

TEST(MeshFiles, PlyKeepsEveryBit) {
    const TemporaryFolder folder;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const MeshData mesh = random_mesh(seed, int(1 + seed * 50));
        Mesh(mesh).save(folder / "m.ply");
        const auto back = Mesh(folder / "m.ply").snapshot();
        EXPECT_TRUE(same_bits(mesh.V, back->V));
        EXPECT_TRUE(same_bits(mesh.N, back->N));
        EXPECT_TRUE(same_bits(mesh.UV, back->UV));
        EXPECT_TRUE(same_bits(mesh.L, back->L));
        EXPECT_TRUE(same_bits(mesh.I, back->I));
        EXPECT_TRUE(same_bits(mesh.T, back->T));
        EXPECT_TRUE(same_bits(mesh.B, back->B));
        ASSERT_EQ(back->scalars.size(), 2u);
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(mesh.scalars[i].name, back->scalars[i].name);
            EXPECT_TRUE(same_bits(mesh.scalars[i].values, back->scalars[i].values));
        }
        EXPECT_TRUE(same_bits(mesh.F, back->F));
        EXPECT_TRUE(same_bits(mesh.E, back->E));
        // Colours are codes of 8 bits in the file; reading multiplies instead of dividing by 255.
        EXPECT_LE((mesh.C - back->C).cwiseAbs().maxCoeff(), 1.2e-7f);
        EXPECT_EQ(back->name, "m");
    }
}

TEST(MeshFiles, ObjKeepsPositionsNormalsAndFaces) {
    const TemporaryFolder folder;
    MeshData mesh = random_mesh(7, 300);
    Mesh(mesh).save(folder / "m.obj");
    EXPECT_FALSE(fs::exists(folder / "m.mtl")) << "no materials, no file for them";
    const auto back = Mesh(folder / "m.obj").snapshot();
    EXPECT_TRUE(same_bits(mesh.V, back->V));
    EXPECT_TRUE(same_bits(mesh.N, back->N));
    EXPECT_TRUE(same_bits(mesh.UV, back->UV));
    EXPECT_TRUE(same_bits(mesh.F, back->F));
    EXPECT_TRUE(same_bits(mesh.E, back->E));
    EXPECT_TRUE(same_bits(ArrayXf::Dense(mesh.C.leftCols(3)), back->C));
}

TEST(MeshFiles, ChildrenAreMergedInWorldSpace) {
    const TemporaryFolder folder;
    Array3f::Dense V(3, 3);
    V << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    Array3i::Dense F(1, 3);
    F << 0, 1, 2;
    const Mesh parent{Array3f(V), Array3i(F)}, child{Array3f(V), Array3i(F)};
    Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
    mirror.translate(Vec3d(10, 0, 0)).scale(Vec3d(-1, 1, 1));
    Mesh moved = child.clone();
    moved.set_T_parent_mesh(mirror);
    Mesh root = parent.clone();
    root.add_child(moved);
    for (const char* name : {"m.ply", "m.obj"}) {
        root.save(folder / name);
        const auto back = Mesh(folder / name).snapshot();
        ASSERT_EQ(back->V.rows(), 6) << name;
        EXPECT_EQ(Vec3(back->V.row(4)), Vec3(9, 0, 0));
        // A mirrored triangle is wound the other way round, so that its outside stays outside.
        EXPECT_EQ(Eigen::Vector3i(back->F.row(1)), Eigen::Vector3i(5, 4, 3));
    }
}

// Two faces along an edge whose vertices the texture coordinates split. At 53 degrees the normals of both
// sides lie halfway between those of the faces, (0, 0, 1) and (0, 0.8, 0.6); at a right angle each side has
// its own.
TEST(MeshFiles, SeamsOfTextureCoordinatesStaySmooth) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, -0.6f, 0.8f}});
    mesh.F = Array3i(Array3i::Dense{{0, 1, 2}, {3, 5, 4}});
    mesh.UV = Array2f(Array2f::Dense{{0, 0}, {1, 0}, {0, 1}, {0.5f, 0}, {1, 1}, {0, 0}});
    mesh.source_vertex = Array1i(Array1i::Dense{{0}, {1}, {2}, {0}, {1}, {3}});
    const Vec3 halfway = Vec3(0, 0.8f, 1.6f).normalized();
    for (const char* name : {"m.obj", "m.ply", "m.npz"}) {
        Mesh(mesh).save(folder / name);
        const auto back = Mesh(folder / name).snapshot();
        ASSERT_EQ(back->N.rows(), 6) << name;
        for (const int corner : {back->F(0, 0), back->F(0, 1), back->F(1, 0), back->F(1, 2)})
            // The angles of corners, which are the weights, are approximated to 1e-5: two may differ by twice
            // that.
            EXPECT_LT((Vec3(back->N.row(corner)) - halfway).norm(), 2e-5f) << name << " " << corner;
    }
    MeshData sharp = mesh;
    sharp.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
    for (const char* name : {"m.obj", "m.ply", "m.npz"}) {
        Mesh(sharp).save(folder / name);
        const auto back = Mesh(folder / name).snapshot();
        ASSERT_EQ(back->N.rows(), 6) << name;
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(Vec3(back->N.row(back->F(0, k))), Vec3(0, 0, 1)) << name;
            EXPECT_EQ(Vec3(back->N.row(back->F(1, k))), Vec3(0, 1, 0)) << name;
        }
    }
    // Without seams files need no normals.
    mesh.source_vertex = Array1i(Array1i::Dense{{0}, {1}, {2}, {3}, {4}, {5}});
    Mesh(mesh).save(folder / "m.ply");
    EXPECT_TRUE(Mesh(folder / "m.ply").N().empty());
}

TEST(MeshFiles, ChildrenWithoutLabelsHaveNone) {
    const TemporaryFolder folder;
    MeshData labelled;
    labelled.V = Array3f(Array3f::Dense::Zero(4, 3));
    labelled.F = Array3i(Array3i::Dense::Zero(2, 3));
    MeshData child = labelled;
    labelled.L = Array1i(Array1i::Dense{{1}, {2}, {3}, {4}});
    Mesh root(labelled);
    root.add_child(Mesh(child));
    child.L = Array1i(Array1i::Dense{{7}, {8}});  // of the faces: they cannot be joined with the vertices'
    root.add_child(Mesh(child));
    root.save(folder / "m.ply");
    const Array1i L = Mesh(folder / "m.ply").L();
    ASSERT_EQ(L.rows(), 12);
    EXPECT_EQ(Eigen::Vector4i(L.head(4)), Eigen::Vector4i(1, 2, 3, 4));
    EXPECT_EQ(L.tail(8).maxCoeff(), no_label);
    EXPECT_EQ(L.tail(8).minCoeff(), no_label);
}

TEST(MeshFiles, PlyWritesLabelsOfFacesBesideThem) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f(Array3f::Dense::Zero(4, 3));
    mesh.F = Array3i(Array3i::Dense{{0, 1, 2}, {0, 2, 3}});
    mesh.L = Array1i(Array1i::Dense{{5}, {-1}});
    Mesh(mesh).save(folder / "m.ply");
    const FileBytes file(folder / "m.ply");
    const std::string text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
    EXPECT_NE(text.find("element face 2\nproperty list uchar int vertex_indices\nproperty int label\n"),
              text.npos);
    // Two faces of 1 + 12 + 4 bytes end the file.
    const std::string first = text.substr(text.size() - 34, 17), second = text.substr(text.size() - 17);
    EXPECT_EQ(first.substr(13), std::string("\5\0\0\0", 4));
    EXPECT_EQ(second.substr(13), "\xff\xff\xff\xff");
    EXPECT_TRUE(same_bits(Mesh(folder / "m.ply").F(), mesh.F));
}

TEST(MeshFiles, AnUnwritableTargetIsAnErrorAndLeavesNothing) {
    const TemporaryFolder folder;
    const Mesh mesh(random_mesh(1, 5));
    EXPECT_THROW(mesh.save(folder / "no/such/m.ply"), FileError);
    EXPECT_THROW(mesh.save(folder / "m.stl"), FormatError);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(MeshFiles, WithoutVerticesReplaceNothing) {
    const TemporaryFolder folder;
    for (const char* name :
         {"m.ply", "m.obj", "m.glb", "m.pcd", "m.xyz", "m.csv", "m.npy", "m.npz", "m.spz"}) {
        write_file(folder / name, "old");
        EXPECT_THROW(Mesh().save(folder / name), ArgumentError) << name;
        EXPECT_EQ(FileBytes(folder / name).text(), "old") << name;
    }
}

TEST(MeshFiles, ScenesNameWhatStandsBesideTheMesh) {
    const TemporaryFolder folder;
    io::LoadedScene scene;
    scene.mesh = Mesh(random_mesh(3, 10));
    scene.lights.emplace("lamp", Light());
    scene.cameras = {{"near", Camera()}, {"far", Camera()}};
    scene.variants = {"red"};
    for (const char* name : {"m.glb", "m.ply"}) {
        std::string warnings;
        set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
        io::save_scene(scene, folder / name);
        set_log_sink({});
        EXPECT_NE(warnings.find("no place for lights (1), cameras (2), material variants (1): left out"),
                  std::string::npos)
            << warnings;
    }
}

}  // namespace easypbr::mesh_roundtrip_test
