// What several nodes share is written into a GLB file once.
#include <gtest/gtest.h>

#include <cstring>

#include "easypbr/io/mesh/gltf/glb_writer.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"

namespace easypbr::glb_shared_test {

namespace {

nlohmann::json json_of(const std::string& glb) {
    uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, 4);
    return nlohmann::json::parse(glb.substr(20, size));
}

MeshData triangle() {
    MeshData data;
    data.name = "rock";
    data.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.F = Array3i::Dense{{0, 1, 2}};
    data.scalars = {{"heat", Array1f::Dense{{1}, {2}, {3}}, true}};
    data.materials.resize(1);
    data.materials[0].name = "grey";
    return data;
}

/// Meshes below a node without vertices; equal arrays are shared.
std::string written(const std::vector<MeshData>& meshes) {
    MeshData root;
    for (const MeshData& mesh : meshes) root.children.emplace_back(mesh);
    return io::encode_glb(Mesh(root));
}

}  // namespace

TEST(GlbShared, MeshesAndMaterialsAreWrittenOnce) {
    std::vector<MeshData> rocks(200, triangle());
    for (size_t i = 0; i < rocks.size(); ++i) {
        rocks[i].name = "rock " + std::to_string(i);
        rocks[i].T_parent_mesh.translation().x() = double(i);
    }
    const std::string glb = written(rocks);
    const nlohmann::json json = json_of(glb);
    EXPECT_EQ(json["nodes"].size(), 200u);
    EXPECT_EQ(json["meshes"].size(), 1u);
    EXPECT_EQ(json["materials"].size(), 1u);
    const io::LoadedScene scene = io::decode_gltf(as_span(glb), "rocks.glb");
    EXPECT_EQ(node(scene, 7).name, "rock 7");
    EXPECT_EQ(node(scene, 7).T_parent_mesh.translation(), Vec3d(7, 0, 0));
    EXPECT_EQ(node(scene, 0).V.revision(), node(scene, 199).V.revision());
}

TEST(GlbShared, MeshesThatDifferInAnythingWrittenAreTheirOwn) {
    const MeshData rock = triangle();
    MeshData moved = rock, red = rock, named = rock, flat = rock, split = rock;
    moved.V = Array3f::Dense{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    red.materials[0].base_color = Vec3(1, 0, 0);
    named.scalars[0].name = "cold";
    flat.style.flat = true;  // without normals in the file
    split.materials.push_back(red.materials[0]);
    split.parts = {{"", 0, 1, 1}};
    const nlohmann::json json = json_of(written({rock, moved, red, named, flat, split, rock}));
    EXPECT_EQ(json["meshes"].size(), 6u);
    EXPECT_EQ(json["materials"].size(), 2u) << "grey and red";
    EXPECT_EQ(json["nodes"].back()["mesh"], 0);
    EXPECT_EQ(json["meshes"][5]["primitives"][0]["material"], json["meshes"][2]["primitives"][0]["material"]);
}

// An automatic alpha mode depends on the colours of the vertices.
TEST(GlbShared, MaterialsOfTransparentVerticesAreTheirOwn) {
    MeshData opaque = triangle(), clear = triangle();
    opaque.C = ArrayXf::Dense{{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    clear.C = ArrayXf::Dense{{1, 1, 1, 0.5f}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    const nlohmann::json json = json_of(written({opaque, clear}));
    EXPECT_EQ(json["meshes"].size(), 2u);
    EXPECT_EQ(json["materials"].size(), 2u);
}

}  // namespace easypbr::glb_shared_test
