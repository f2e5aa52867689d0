// Coordinates far from zero through files: what is read, and what is written back.
#include <cmath>
#include <string>

#include "easypbr/core/file.h"
#include "easypbr/geometry/place.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/scene.h"
#include "io/ply_builder.h"
#include "io/temporary_folder.h"

namespace easypbr::offset_files_test {

namespace {

const Vec3d corner(691'000.125, 5'335'000.25, 520.5);

/// A grid of 20 x 20 points, 5 m apart and a millimetre beside it.
Vec3d grid_point(int i) {
    return corner + Vec3d(5.0 * (i % 20), 5.0 * (i / 20), 0.001 * i);
}

constexpr int grid_count = 400;
// Half the spacing of float32 numbers up to 128 m.
const double tolerance = std::exp2(-18.0);

void expect_grid(const MeshData& mesh, const std::string& what, double within = tolerance) {
    ASSERT_EQ(mesh.V.rows(), grid_count) << what;
    EXPECT_LT(mesh.V.cwiseAbs().maxCoeff(), 128) << what;
    for (int i = 0; i < grid_count; ++i) {
        const Vec3d position = mesh.offset + mesh.V.row(i).transpose().cast<double>();
        EXPECT_LE((position - grid_point(i)).cwiseAbs().maxCoeff(), within) << what << " " << i;
    }
}

std::string far_ply(const std::string& format) {
    PlyBuilder ply(format);
    ply.header(
        "element camera 1\nproperty float f\nelement vertex 400\nproperty uchar red\nproperty double x");
    ply.header("property uchar green\nproperty double y\nproperty uchar blue\nproperty double z");
    ply.header("element face 1\nproperty list uchar int vertex_indices").end_header();
    ply.value("float", 1).end_row();
    for (int i = 0; i < grid_count; ++i) {
        const Vec3d p = grid_point(i);
        ply.value("uchar", 255).value("double", p.x()).value("uchar", 0).value("double", p.y());
        ply.value("uchar", 0).value("double", p.z()).end_row();
    }
    ply.value("uchar", 3).values("int", {0, 1, 20}).end_row();
    return ply.text();
}

}  // namespace

TEST(FarFiles, PlyOfDoublesKeepsMillimetres) {
    const TemporaryFolder folder;
    for (const std::string format : {"binary_little_endian", "binary_big_endian", "ascii"}) {
        write_file(folder / "far.ply", far_ply(format));
        const auto mesh = Mesh(folder / "far.ply").snapshot();
        expect_grid(*mesh, format);
        EXPECT_EQ(mesh->C(399, 0), 1) << "the fields between are read as before";
        EXPECT_EQ(mesh->F(0, 2), 20);
    }
}

TEST(FarFiles, ObjKeepsMillimetres) {
    const TemporaryFolder folder;
    std::string text = "# far\n";
    for (int i = 0; i < grid_count; ++i) {
        const Vec3d p = grid_point(i);
        text += fmt::format("v {} {} {} 1 0.5 0\n", p.x(), p.y(), p.z());
    }
    write_file(folder / "far.obj", text + "f 1 2 21\n");
    const auto mesh = Mesh(folder / "far.obj").snapshot();
    expect_grid(*mesh, "obj");
    EXPECT_EQ(mesh->C(7, 1), 0.5f);
}

TEST(FarFiles, FloatsAreRecentredWithoutLoss) {
    const TemporaryFolder folder;
    PlyBuilder ply("binary_little_endian");
    ply.header("element vertex 400\nproperty float x\nproperty float y\nproperty float z").end_header();
    for (int i = 0; i < grid_count; ++i) ply.values("float", grid_point(i));
    write_file(folder / "far.ply", ply.text());
    const auto mesh = Mesh(folder / "far.ply").snapshot();
    EXPECT_NE(mesh->offset, Vec3d::Zero());
    for (int i = 0; i < grid_count; ++i)
        EXPECT_EQ(mesh->offset + mesh->V.row(i).transpose().cast<double>(),
                  grid_point(i).cast<float>().cast<double>())
            << i;
}

TEST(FarFiles, OffsetComesBackFromFilesThatWereSaved) {
    const TemporaryFolder folder;
    write_file(folder / "far.ply", far_ply("binary_little_endian"));
    const Mesh mesh(folder / "far.ply");
    for (const char* name : {"saved.ply", "saved.obj"}) {
        mesh.save(folder / name);
        const auto back = Mesh(folder / name).snapshot();
        EXPECT_EQ(back->offset, mesh.offset()) << name;
        EXPECT_EQ(back->V, mesh.V()) << name;
    }
    // GLB holds float32 positions; a node around them holds the offset.
    mesh.save(folder / "saved.glb");
    Scene scene;
    scene.show(Mesh(folder / "saved.glb"), "glb");
    const SceneSnapshot snapshot = scene.snapshot();
    const auto& object = snapshot.objects.back();
    EXPECT_EQ(object.mesh->V, mesh.V());
    EXPECT_EQ(object.T_world_mesh.translation(), mesh.offset());
}

// The offset is the translation of a node in a GLB: of what is read from it every format and box has it
// again.
TEST(FarFiles, GlbKeepsMillimetresInOtherFormats) {
    const TemporaryFolder folder;
    write_file(folder / "far.ply", far_ply("binary_little_endian"));
    Mesh(folder / "far.ply").save(folder / "far.glb");
    const Mesh glb(folder / "far.glb");
    for (const char* name : {"saved.ply", "saved.obj", "saved.npz", "saved.xyz"}) {
        glb.save(folder / name);
        // Half a spacing when the GLB was written, and half a one when its nodes were merged.
        expect_grid(*Mesh(folder / name).snapshot(), name, 2 * tolerance);
    }
    EXPECT_LE((bounding_box(glb).min() - corner).cwiseAbs().maxCoeff(), 2 * tolerance);
    Mesh moved = make_box();
    moved.translate(corner);
    moved.save(folder / "moved.ply");
    EXPECT_LE((bounding_box(Mesh(folder / "moved.ply")).center() - corner).cwiseAbs().maxCoeff(), tolerance);
}

TEST(FarFiles, ChildrenWithOtherOffsetsAreSavedInPlace) {
    const TemporaryFolder folder;
    write_file(folder / "far.ply", far_ply("binary_little_endian"));
    Mesh mesh(folder / "far.ply"), child = mesh.clone();
    child.set_offset(child.offset() + Vec3d(1000, 0, 0));
    mesh.add_child(child);
    mesh.save(folder / "saved.glb");
    mesh.save(folder / "saved.ply");
    const auto merged = Mesh(folder / "saved.ply").snapshot();
    Scene scene;
    scene.show(Mesh(folder / "saved.glb"), "glb");
    const SceneSnapshot snapshot = scene.snapshot();
    const auto position = [&](size_t object) {
        return Vec3d(snapshot.objects[object].T_world_mesh *
                     snapshot.objects[object].mesh->V.row(0).transpose().cast<double>());
    };
    std::vector<Vec3d> first;
    for (size_t i = 0; i < snapshot.objects.size(); ++i)
        if (!snapshot.objects[i].mesh->V.empty()) first.push_back(position(i));
    ASSERT_EQ(first.size(), 2u);
    EXPECT_EQ(first[1] - first[0], Vec3d(1000, 0, 0));
    // The merged cloud reaches 1100 m: half the spacing there.
    const Vec3d second = merged->offset + merged->V.row(grid_count).transpose().cast<double>();
    EXPECT_LE((second - grid_point(0) - Vec3d(1000, 0, 0)).cwiseAbs().maxCoeff(), std::exp2(-13.0));
}

}  // namespace easypbr::offset_files_test
