// Meshes that share accessors have the vertices that their own primitives index.
#include <gtest/gtest.h>

#include <vector>

#include "easypbr/core/memory_budget.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"

namespace easypbr::gltf_shared_test {

namespace {

using Json = nlohmann::json;

/// Corners of two unit squares, the second 100 further along x.
const std::vector<float> two_squares = {0,   0, 0, 1,   0, 0, 1,   1, 0, 0,   1, 0,
                                        100, 0, 0, 101, 0, 0, 101, 1, 0, 100, 1, 0};

size_t add_indices(GltfBuilder& file, const std::vector<uint32_t>& indices) {
    return file.accessor(indices, 5125, "SCALAR", indices.size());
}

Array3f::Dense half(int first) {
    return Eigen::Map<const Array3f::Dense>(two_squares.data() + 3 * first, 4, 3);
}

/// An accessor of `count` positions without a buffer view, all zero but for the rows of a triangle.
size_t add_sparse_positions(GltfBuilder& file, size_t count, const std::vector<uint32_t>& rows) {
    const size_t where = file.view(rows), values = file.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    Json accessor = {{"componentType", 5126}, {"count", count}, {"type", "VEC3"}};
    accessor["sparse"] = {{"count", 3},
                          {"indices", {{"bufferView", where}, {"componentType", 5125}}},
                          {"values", {{"bufferView", values}}}};
    file.json["accessors"].push_back(accessor);
    return file.json["accessors"].size() - 1;
}

/// Another mesh, of no node, that indexes positions too.
void share(GltfBuilder& file, const Json& attributes) {
    const Json other = {{"attributes", {{"POSITION", attributes["POSITION"]}}},
                        {"indices", add_indices(file, {0, 1, 2})}};
    file.json["meshes"].push_back({{"primitives", {other}}});
}

}  // namespace

TEST(GltfShared, AMeshHasTheVerticesThatItIndexes) {
    GltfBuilder file;
    const Json attributes = {{"POSITION", file.floats(two_squares, 3)}};
    const size_t near = add_indices(file, {0, 1, 2, 0, 2, 3}), far = add_indices(file, {4, 5, 6, 4, 6, 7});
    for (const size_t indices : {near, far})
        file.json["meshes"].push_back({{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}});
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}, {"translation", {-98, 0, 0}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    const io::LoadedScene scene = decode(file);
    EXPECT_EQ(node(scene, 0).V, half(0));
    EXPECT_EQ(node(scene, 1).V, half(4));
    EXPECT_EQ(node(scene, 1).F, (Array3i::Dense{{0, 1, 2}, {0, 2, 3}}));
}

TEST(GltfShared, MalformedMeshesOfNoNodeAreLeftOut) {
    GltfBuilder file;
    file.triangle();
    for (const Json& mesh : {Json(nullptr), Json(7), Json{{"primitives", 7}}})
        file.json["meshes"].push_back(mesh);
    EXPECT_EQ(node(decode(file)).V.rows(), 3);
}

TEST(GltfShared, PrimitivesOfOneMeshShareVertices) {
    GltfBuilder file;
    const Json attributes = {{"POSITION", file.floats(two_squares, 3)}};
    const size_t last = add_indices(file, {7, 6, 4}), first = add_indices(file, {6, 5, 4});
    file.json["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
    file.json["meshes"] = {{{"primitives",
                             {{{"attributes", attributes}, {"indices", last}, {"material", 0}},
                              {{"attributes", attributes}, {"indices", first}, {"material", 1}}}}}};
    share(file, attributes);
    const MeshData mesh = node(decode(file));
    EXPECT_EQ(mesh.V, half(4)) << "in the order of the file";
    EXPECT_EQ(mesh.F, (Array3i::Dense{{3, 2, 0}, {2, 1, 0}}));
    EXPECT_EQ(mesh.parts.size(), 2u);
    // A primitive without indices has all.
    file.json["meshes"][0]["primitives"][1].erase("indices");
    EXPECT_EQ(node(decode(file)).V.rows(), 8);
}

// Of four vertices the second and the last two are used: (1, 0, 0), (1, 1, 0), (0, 1, 0). The target moves
// vertex i by i + 1 along z; its weight is 1. The joint moves all by 10 along y.
TEST(GltfShared, AttributesTargetsAndJointsGoWithTheirVertices) {
    GltfBuilder file;
    const std::vector<float> corners(two_squares.begin(), two_squares.begin() + 12);
    const std::vector<float> one_joint = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const Json attributes = {{"POSITION", file.floats(corners, 3)},
                             {"NORMAL", file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0}, 3)},
                             {"TEXCOORD_0", file.floats({0, 1, 0.25f, 1, 0.5f, 1, 0.75f, 1}, 2)},
                             {"COLOR_0", file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3)},
                             {"_heat", file.floats({5, 6, 7, 8}, 1)},
                             {"JOINTS_0", file.accessor(std::vector<uint8_t>(16, 0), 5121, "VEC4", 4)},
                             {"WEIGHTS_0", file.floats(one_joint, 4)}};
    const Json targets = {{{"POSITION", file.floats({0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4}, 3)}}};
    const size_t indices = add_indices(file, {1, 2, 3});
    file.json["meshes"] = {
        {{"primitives", {{{"attributes", attributes}, {"targets", targets}, {"indices", indices}}}},
         {"weights", {1}}}};
    share(file, attributes);
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"translation", {0, 10, 0}}}};
    file.json["skins"] = {{{"joints", {1}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    const io::LoadedScene scene = decode(file);
    const MeshData mesh = node(scene);
    EXPECT_EQ(mesh.N, (Array3f::Dense{{0, 1, 0}, {0, 0, 1}, {0, -1, 0}}));
    EXPECT_EQ(mesh.UV, (Array2f::Dense{{0.25f, 0}, {0.5f, 0}, {0.75f, 0}}));
    // The sRGB curve rounds 1.
    EXPECT_TRUE(mesh.C.isApprox(ArrayXf::Dense{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1e-6f)) << mesh.C;
    EXPECT_EQ(mesh.scalars.at(0).values, (Array1f::Dense{{6}, {7}, {8}}));
    const Eigen::Affine3d T = scene.mesh.children()[0].T_world_mesh();
    const Array3d::Dense world{{1, 10, 2}, {1, 11, 3}, {0, 11, 4}};
    for (Eigen::Index i = 0; i < 3; ++i) {
        const Vec3d place = T * Vec3d(mesh.V.row(i).transpose().cast<double>());
        // Small whole numbers, but the pose's inverse rounds.
        EXPECT_LT((place - world.row(i).transpose()).norm(), 1e-5) << i;
    }
}

// Few indices of many rows are sorted, many of few rows are marked: both find the same.
TEST(GltfShared, FindsRowsAmongFewAndMany) {
    for (const size_t count : {size_t(10), size_t(5000)}) {
        GltfBuilder file;
        const Json attributes = {{"POSITION", add_sparse_positions(file, count, {2, 5, 9})}};
        file.json["meshes"] = {
            {{"primitives",
              {{{"attributes", attributes}, {"indices", add_indices(file, {9, 2, 5, 5, 2, 7})}}}}}};
        share(file, attributes);
        const MeshData mesh = node(decode(file));
        EXPECT_EQ(mesh.V, (Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}})) << count;
        EXPECT_EQ(mesh.F, (Array3i::Dense{{3, 0, 1}, {1, 0, 2}})) << count;
    }
}

// 40 meshes over a million positions: all vertices of each would be 480 MB, their own are 36 bytes each.
TEST(GltfShared, WhatIsLeftOutTakesNoMemory) {
    GltfBuilder file;
    const size_t count = 1'000'000;
    const Json attributes = {{"POSITION", add_sparse_positions(file, count, {0, 1, 2})}};
    for (uint32_t i = 0; i < 40; ++i) {
        const size_t indices = add_indices(file, {i, i + 1, i + 2});
        file.json["meshes"].push_back({{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}});
        file.json["nodes"][i] = {{"mesh", i}};
        file.json["scenes"][0]["nodes"][i] = i;
    }
    const MemoryScope scope("shared.glb", 1 << 20);
    EXPECT_EQ(decode(file).mesh.children().size(), 40u);
}

// What a mesh alone has keeps its numbers, as in other formats.
TEST(GltfShared, AMeshKeepsVerticesThatNoneIndexes) {
    GltfBuilder file;
    const Json attributes = {{"POSITION", file.floats(two_squares, 3)}};
    const Json primitive = {{"attributes", attributes}, {"indices", add_indices(file, {4, 5, 6})}};
    file.json["meshes"] = {{{"primitives", {primitive}}}, {{"primitives", {primitive}}, {"name", "again"}}};
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    const io::LoadedScene scene = decode(file);
    for (const size_t i : {0, 1}) {
        EXPECT_EQ(node(scene, i).V.rows(), 8);
        EXPECT_EQ(node(scene, i).F, (Array3i::Dense{{4, 5, 6}}));
    }
}

TEST(GltfShared, RowsThatAreMissingAreABadFile) {
    GltfBuilder file;
    const Json attributes = {{"POSITION", file.floats(two_squares, 3)},
                             {"NORMAL", file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3)}};
    file.json["meshes"] = {
        {{"primitives", {{{"attributes", attributes}, {"indices", add_indices(file, {0, 1, 2})}}}}}};
    EXPECT_NE(message_of(file).find("has 8 positions, but accessors[1] has 4 rows"), std::string::npos);
}

// float32 has all whole numbers up to 2^24 = 16777216, and not the next one.
TEST(GltfShared, AWarningNamesIdsThatFloat32Merges) {
    const auto said = [](uint32_t first) {
        GltfBuilder file;
        const std::vector<uint32_t> ids = {first, first + 1, first + 2};
        file.triangle();
        const size_t values = file.accessor(ids, 5125, "SCALAR", 3);
        file.json["meshes"][0]["primitives"][0]["attributes"]["_ID"] = values;
        const LogCapture log;
        decode(file);
        return log.text;
    };
    EXPECT_NE(said(16777216).find("scalars 'ID'"), std::string::npos) << said(16777216);
    EXPECT_NE(said(16777216).find("holds 16777216 and 16777217 as one number"), std::string::npos);
    EXPECT_EQ(said(16777214), "");
}

}  // namespace easypbr::gltf_shared_test
