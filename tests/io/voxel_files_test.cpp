// What positions and labels mean is kept, or named as left out: the size of voxels, the map of labels.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/geometry/voxels.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "io/npy_builder.h"
#include "io/temporary_folder.h"

namespace easypbr::voxel_files_test {
namespace {

/// Two voxels of an edge that is no power of two: files keep each bit of it.
constexpr float edge = 0.3f;

Mesh voxels(float size = edge) {
    const std::vector<uint8_t> occupied{1, 1};
    return make_voxels({.cells = {1, 1, 2}, .cell_size = double(size)}, occupied);
}

/// The only mesh of a file that has vertices.
std::shared_ptr<const MeshData> mesh_in(const fs::path& path) {
    std::shared_ptr<const MeshData> found;
    for_each_node(Mesh(path), [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        if (!data->V.empty()) found = data;
    });
    return found;
}

/// What saving warns of.
std::string saved(const Mesh& mesh, const fs::path& path) {
    std::string warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
    mesh.save(path);
    set_log_sink({});
    return warnings;
}

struct ReadNpz {
    float voxel_size = 0;
    std::string warnings;
};

/// Of an NPZ file of a triangle's vertices, with this array of a voxel size.
ReadNpz read_npz(float size, const std::string& shape, bool has_faces) {
    const std::string V = Bytes().add_all({0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}).str();
    std::vector<std::pair<std::string, std::string>> entries{
        {"V.npy", npy("'<f4'", "(3, 3)", V)},
        {"voxel_size.npy", npy("'<f8'", shape, Bytes().add(double(size)).str())}};
    if (has_faces)
        entries.emplace_back("F.npy", npy("'<i4'", "(1, 3)", Bytes().add_all<int32_t>({0, 1, 2}).str()));
    const std::string bytes = npz(entries);
    ReadNpz result;
    set_log_sink([&](LogLevel, std::string_view message) { result.warnings += std::string(message) + "\n"; });
    result.voxel_size = io::read_npz(io::Source(std::string_view(bytes), "a.npz")).voxel_size;
    set_log_sink({});
    return result;
}

bool names(const std::string& warnings, std::string_view what) {
    return warnings.find(what) != std::string::npos;
}

}  // namespace

TEST(VoxelFiles, GlbAndNpzKeepTheSize) {
    const TemporaryFolder folder;
    for (const char* name : {"v.glb", "v.npz"}) {
        EXPECT_EQ(saved(voxels(), folder / name), "") << name;
        EXPECT_EQ(mesh_in(folder / name)->voxel_size, edge) << name;
    }
}

TEST(VoxelFiles, OtherFormatsNameTheSize) {
    const TemporaryFolder folder;
    for (const char* name : {"v.ply", "v.obj", "v.pcd", "v.csv", "v.xyz", "v.npy"}) {
        EXPECT_TRUE(names(saved(voxels(), folder / name), "no place for the voxel size: left out")) << name;
        EXPECT_EQ(mesh_in(folder / name)->voxel_size, 0) << name;
    }
}

TEST(VoxelFiles, GridsOfSeveralSizesAreOneMeshWithoutASize) {
    const TemporaryFolder folder;
    Mesh both;
    both.add_child(voxels());
    both.add_child(voxels(2 * edge));
    EXPECT_TRUE(names(saved(both, folder / "v.npz"), "no place for the voxel size"));
    EXPECT_EQ(saved(both, folder / "v.glb"), "");
    const Mesh glb(folder / "v.glb");
    ASSERT_EQ(glb.children().size(), 2u);
    EXPECT_EQ(glb.children()[0].snapshot()->voxel_size, edge);
    EXPECT_EQ(glb.children()[1].snapshot()->voxel_size, 2 * edge);
}

// A mesh of a reconstruction may have been made on a grid of that size.
TEST(VoxelFiles, NpzOfFacesHasNoVoxels) {
    const TemporaryFolder folder;
    MeshData mesh = *voxels().snapshot();
    mesh.F = Array3i::Dense::Zero(1, 3);
    EXPECT_TRUE(names(saved(Mesh(mesh), folder / "v.npz"), "no place for the voxel size"));
    EXPECT_EQ(mesh_in(folder / "v.npz")->voxel_size, 0);
}

// np.savez(voxel_size=0.3) writes no dimension, this library one.
TEST(VoxelFiles, NpzHasASizeOfAnyShapeOfOneNumber) {
    for (const char* shape : {"()", "(1,)", "(1, 1)"}) {
        const ReadNpz read = read_npz(edge, shape, false);
        EXPECT_EQ(read.voxel_size, edge) << shape;
        EXPECT_EQ(read.warnings, "") << shape;
    }
}

TEST(VoxelFiles, NpzSaysWhichSizesAreLeftOut) {
    struct Case {
        float size;
        bool has_faces;
    };
    for (const Case& c : {Case{edge, true}, Case{-1, false}, Case{0, false}, Case{INFINITY, false}}) {
        const ReadNpz read = read_npz(c.size, "()", c.has_faces);
        EXPECT_EQ(read.voxel_size, 0) << c.size;
        EXPECT_EQ(read.warnings,
                  "a.npz: array 'voxel_size' is left out: expected a finite number above 0 beside points "
                  "without faces\n")
            << c.size;
    }
}

TEST(VoxelFiles, AScalarOfThatNameIsNoSize) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f::Dense::Zero(1, 3);
    mesh.scalars = {{"voxel_size", Array1f::Dense::Constant(1, 7)}};
    saved(Mesh(mesh), folder / "v.npz");
    const auto back = mesh_in(folder / "v.npz");
    EXPECT_EQ(back->voxel_size, 0);
    ASSERT_EQ(back->scalars.size(), 1u);
    EXPECT_EQ(back->scalars[0].name, "voxel_size");
}

TEST(VoxelFiles, LabelMapsAreNamed) {
    const TemporaryFolder folder;
    Mesh mesh = voxels();
    Array1i::Dense labels(2);
    labels << 0, 1;
    mesh.set_labels(labels, std::make_shared<const LabelMap>(LabelMap::generated({"a", "b"})));
    for (const char* name : {"v.glb", "v.npz", "v.ply", "v.pcd"}) {
        EXPECT_TRUE(names(saved(mesh, folder / name), "the label map: left out")) << name;
    }
    mesh.set_label_map(std::shared_ptr<const LabelMap>());
    EXPECT_EQ(saved(mesh, folder / "v.npz"), "");
}

}  // namespace easypbr::voxel_files_test
