// Faces without normals beside others that have some.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/io/mesh/gltf/gltf_vertices.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"

namespace easypbr::io::gltf_normals_test {
namespace {

/// Two triangles that share the edge along y, one in the plane z = 0, the other in x = 0, without normals;
/// and one more triangle, with or without.
GltfBuilder folded(bool has_normals) {
    GltfBuilder builder;
    nlohmann::json& first = builder.triangle();
    first["attributes"]["POSITION"] = builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3);
    first["attributes"]["TEXCOORD_0"] = builder.floats({0, 0, 0.25f, 0, 0.5f, 0, 0.75f, 0}, 2);
    first["indices"] = builder.accessor(std::vector<uint32_t>{0, 1, 2, 0, 2, 3}, 5125, "SCALAR", 6);
    const size_t position = builder.floats({5, 0, 0, 6, 0, 0, 5, 1, 0}, 3);
    nlohmann::json second = {{"attributes", {{"POSITION", position}}}};
    if (has_normals) second["attributes"]["NORMAL"] = builder.floats({0, 0, 1, 0, 1, 0, 1, 0, 0}, 3);
    builder.json["meshes"][0]["primitives"].push_back(second);
    return builder;
}

/// The normals of a face's corners.
Array3f::Dense corner_normals(const MeshData& mesh, Eigen::Index face) {
    Array3f::Dense N(3, 3);
    for (int k = 0; k < 3; ++k) N.row(k) = mesh.N.row(mesh.F(face, k));
    return N;
}

Array3f::Dense all_of(float x, float y, float z) {
    return Eigen::RowVector3f(x, y, z).replicate(3, 1);
}

// glTF 2.0, section 3.7.2.1: normals that are not given are those of the faces.
TEST(GltfNormals, FacesWithoutNormalsAreFlatBesideOthers) {
    const MeshData mesh = node(decode(folded(true)));
    EXPECT_EQ(mesh.F, (Array3i::Dense{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}));
    // Vectors along axes are exact.
    EXPECT_EQ(corner_normals(mesh, 0), all_of(0, 0, 1));
    EXPECT_EQ(corner_normals(mesh, 1), all_of(1, 0, 0));
    EXPECT_EQ(corner_normals(mesh, 2), (Array3f::Dense{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
    EXPECT_EQ(Vec3(mesh.V.row(5)), Vec3(0, 0, 1));
    EXPECT_EQ(mesh.UV(5, 0), 0.75f) << "goes with its vertex";
    EXPECT_EQ(mesh.source_vertex, (Array1i::Dense{{0}, {1}, {2}, {0}, {2}, {3}, {4}, {5}, {6}}));
    EXPECT_FALSE(mesh.style.flat.value().has_value());
}

TEST(GltfNormals, AMeshWithoutAnyIsDrawnFlat) {
    const MeshData mesh = node(decode(folded(false)));
    EXPECT_EQ(mesh.V.rows(), 7);
    EXPECT_TRUE(mesh.N.empty() && mesh.source_vertex.empty());
    EXPECT_TRUE(mesh.style.flat.value_or(false));
}

// Lines that are the E of the faces, as they are written.
TEST(GltfNormals, LinesKeepTheirVertices) {
    GltfBuilder builder = folded(true);
    nlohmann::json& primitives = builder.json["meshes"][0]["primitives"];
    nlohmann::json lines = primitives[0];
    lines["mode"] = 1;
    lines["indices"] = builder.accessor(std::vector<uint32_t>{3, 1}, 5125, "SCALAR", 2);
    primitives.push_back(lines);
    primitives.push_back({{"attributes", primitives[1]["attributes"]}, {"mode", 1}, {"indices", 0}});
    primitives[3]["indices"] = builder.accessor(std::vector<uint32_t>{0, 2}, 5125, "SCALAR", 2);
    for (const size_t i : {2u, 3u}) primitives[i]["extras"] = {{"EasyPBR:edges_of_faces", true}};
    const MeshData mesh = node(decode(builder));
    ASSERT_EQ(mesh.V.rows(), 4 + 6 + 3);
    ASSERT_EQ(mesh.E.rows(), 2);
    EXPECT_EQ(Vec3(mesh.V.row(mesh.E(0, 0))), Vec3(0, 0, 1));
    EXPECT_EQ(Vec3(mesh.V.row(mesh.E(0, 1))), Vec3(1, 0, 0));
    EXPECT_EQ(Vec3(mesh.V.row(mesh.E(1, 1))), Vec3(5, 1, 0));
    EXPECT_EQ(corner_normals(mesh, 1), all_of(1, 0, 0));
    EXPECT_EQ(Vec3(mesh.V.row(mesh.F(1, 2))), Vec3(0, 0, 1));
}

// The target lifts (0, 1, 0) to (0, 1, 1): the first face has the normal (0, -1, 1) / sqrt(2) then, the
// second the one that it had.
TEST(GltfNormals, FlatFacesAreFlatInEveryPose) {
    GltfBuilder builder = folded(true);
    nlohmann::json& primitives = builder.json["meshes"][0]["primitives"];
    const size_t lifted = builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, 3),
                 still = builder.floats(std::vector<float>(9, 0), 3);
    primitives[0]["targets"] = {{{"POSITION", lifted}}};
    primitives[1]["targets"] = {{{"POSITION", still}}};
    builder.json["meshes"][0]["weights"] = {1};
    const MeshData mesh = node(decode(builder));
    const float half = std::sqrt(0.5f);
    // Rounding of a division and a root.
    EXPECT_TRUE(corner_normals(mesh, 0).isApprox(all_of(0, -half, half), 1e-6f)) << mesh.N;
    EXPECT_TRUE(corner_normals(mesh, 1).isApprox(all_of(1, 0, 0), 1e-6f)) << mesh.N;
    EXPECT_EQ(corner_normals(mesh, 2), (Array3f::Dense{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
}

// Blocks say how many vertices they have; none are made of more than 32-bit indices count.
TEST(GltfNormals, TooManyVerticesAreABadFile) {
    std::vector<VertexBlock> blocks(2);
    VertexBlock &smooth = blocks[0], &flat = blocks[1];
    smooth.N.resize(1, 3);
    smooth.row_count = std::numeric_limits<int32_t>::max() - 4;
    flat.first = smooth.row_count;
    flat.V = Array3f::Dense::Zero(4, 3);
    flat.row_count = 4;
    flat.triangles = {0, 1, 2, 1, 2, 3};
    const int32_t first = int32_t(flat.first);
    std::vector<int32_t> faces{first, first + 1, first + 2, first + 1, first + 2, first + 3}, edges;
    // The faces' six corners are two vertices too many.
    EXPECT_THROW(split_flat_faces(blocks, faces, edges, "mesh"), FormatError);
    EXPECT_EQ(flat.V.rows(), 4);
    EXPECT_EQ(flat.first, smooth.row_count);
}

}  // namespace
}  // namespace easypbr::io::gltf_normals_test
