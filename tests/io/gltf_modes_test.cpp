// Faces, lines and points of one glTF mesh are drawn side by side, each with its own material.
#include <gtest/gtest.h>

#include <vector>

#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"

namespace easypbr::gltf_modes_test {

namespace {

using Json = nlohmann::json;

constexpr int points_mode = 0, lines_mode = 1, strip_mode = 3, triangles_mode = 4;

/// A unit square's corners, without primitives. Material 0 is red, 1 blue.
class Square : public GltfBuilder {
  public:
    Square() {
        attributes = {{"POSITION", floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3)}};
        for (const Json& color : {Json{1, 0, 0, 1}, Json{0, 0, 1, 1}})
            json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorFactor", color}}}});
        json["meshes"] = {{{"name", "shape"}}};
    }

    void add(int mode, int material, const std::vector<uint32_t>& indices) {
        const size_t accessor_of_indices = accessor(indices, 5125, "SCALAR", indices.size());
        json["meshes"][0]["primitives"].push_back({{"attributes", attributes},
                                                   {"mode", mode},
                                                   {"material", material},
                                                   {"indices", accessor_of_indices}});
    }

    Json attributes;
};

MeshData child(const MeshData& mesh, size_t index) {
    return *mesh.children.at(index).snapshot();
}

Vec3 color(const MeshData& mesh) {
    return mesh.materials.at(0).base_color;
}

const Vec3 red(1, 0, 0), blue(0, 0, 1);

}  // namespace

TEST(GltfModes, LinesOfTwoMaterialsKeepBoth) {
    Square file;
    file.add(lines_mode, 0, {0, 1});
    file.add(lines_mode, 1, {2, 3});
    const MeshData mesh = node(decode(file));
    EXPECT_EQ(mesh.name, "shape");
    EXPECT_EQ(color(mesh), red);
    EXPECT_EQ(mesh.V, (Array3f::Dense{{0, 0, 0}, {1, 0, 0}}));
    EXPECT_EQ(mesh.E, (Array2i::Dense{{0, 1}}));
    ASSERT_EQ(mesh.children.size(), 1u);
    EXPECT_EQ(color(child(mesh, 0)), blue);
    EXPECT_EQ(child(mesh, 0).V, (Array3f::Dense{{1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(child(mesh, 0).E, (Array2i::Dense{{0, 1}}));
    EXPECT_EQ(child(mesh, 0).name, "lines 0");
}

TEST(GltfModes, PrimitivesOfOneMaterialAreOneMesh) {
    Square file;
    file.add(lines_mode, 0, {0, 1});
    file.add(strip_mode, 0, {1, 2, 3});
    const MeshData mesh = node(decode(file));
    EXPECT_TRUE(mesh.children.empty());
    EXPECT_EQ(mesh.E, (Array2i::Dense{{0, 1}, {1, 2}, {2, 3}}));
}

TEST(GltfModes, FacesAreTheMeshAndOthersItsChildren) {
    Square file;
    file.add(points_mode, 1, {3});
    file.add(lines_mode, 1, {2, 3});
    file.add(triangles_mode, 0, {0, 1, 2});
    const MeshData mesh = node(decode(file));
    EXPECT_EQ(mesh.F.rows(), 1);
    EXPECT_TRUE(mesh.E.empty());
    EXPECT_EQ(color(mesh), red);
    ASSERT_EQ(mesh.children.size(), 2u);
    const MeshData points = child(mesh, 0), lines = child(mesh, 1);
    EXPECT_EQ(points.V, (Array3f::Dense{{0, 1, 0}}));
    EXPECT_TRUE(points.E.empty() && points.F.empty());
    EXPECT_EQ(color(points), blue);
    EXPECT_EQ(lines.E.rows(), 1);
    EXPECT_EQ(color(lines), blue);
}

TEST(GltfModes, PointsBesideLinesAreKept) {
    Square file;
    file.add(lines_mode, 0, {0, 1});
    file.add(points_mode, 0, {2, 3});
    const MeshData mesh = node(decode(file));
    EXPECT_EQ(mesh.V.rows(), 2);
    ASSERT_EQ(mesh.children.size(), 1u);
    EXPECT_EQ(child(mesh, 0).V, (Array3f::Dense{{1, 1, 0}, {0, 1, 0}}));
}

TEST(GltfModes, EachNodeHasChildrenOfItsOwn) {
    Square file;
    file.add(triangles_mode, 0, {0, 1, 2});
    file.add(lines_mode, 1, {2, 3});
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    const io::LoadedScene scene = decode(file);
    const Mesh first = node(scene, 0).children.at(0), second = node(scene, 1).children.at(0);
    EXPECT_NE(first.identity(), second.identity());
    EXPECT_EQ(first.V().revision(), second.V().revision());
}

// A target lifts all by 1, with weights from 0 to 2 in two seconds; the material's red goes from 0 to 1.
TEST(GltfModes, AnimationsReachTheChildren) {
    Square file;
    file.add(triangles_mode, 0, {0, 1, 2});
    file.add(lines_mode, 1, {2, 3});
    const Json target = {{"POSITION", file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3)}};
    for (Json& primitive : file.json["meshes"][0]["primitives"]) primitive["targets"] = {target};
    const size_t input = file.floats({0, 2}, 1), weights = file.floats({0, 2}, 1),
                 colors = file.floats({0, 0, 1, 1, 1, 0, 1, 1}, 4);
    const Json pointer = {{"pointer", "/materials/1/pbrMetallicRoughness/baseColorFactor"}};
    const Json to_weights = {{"node", 0}, {"path", "weights"}},
               to_color = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", pointer}}}};
    file.json["animations"] = {
        {{"samplers", {{{"input", input}, {"output", weights}}, {{"input", input}, {"output", colors}}}},
         {"channels", {{{"sampler", 0}, {"target", to_weights}}, {{"sampler", 1}, {"target", to_color}}}}}};
    io::LoadedScene scene = decode(file);
    scene.animations.apply(0, 1);
    const MeshData mesh = node(scene);
    EXPECT_EQ(mesh.V.col(2).minCoeff(), 1);
    EXPECT_EQ(child(mesh, 0).V.col(2).minCoeff(), 1);
    EXPECT_EQ(color(child(mesh, 0)), Vec3(0.5f, 0, 1));
    EXPECT_TRUE(child(mesh, 0).materials.at(0).base_color_given);  // should it pass the default one
    EXPECT_EQ(color(mesh), red);
}

// The node's own translation does not count for what follows joints; the joint lifts by 3.
TEST(GltfModes, ChildrenFollowJoints) {
    Square file;
    const std::vector<float> one_joint = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    file.attributes["JOINTS_0"] = file.accessor(std::vector<uint8_t>(16, 0), 5121, "VEC4", 4);
    file.attributes["WEIGHTS_0"] = file.floats(one_joint, 4);
    file.add(triangles_mode, 0, {0, 1, 2});
    file.add(lines_mode, 1, {2, 3});
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {0, 0, 50}}},
                          {{"translation", {0, 0, 3}}}};
    file.json["skins"] = {{{"joints", {1}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    const io::LoadedScene scene = decode(file);
    const Mesh mesh = scene.mesh.children()[0];
    for (const Mesh& part : {mesh, mesh.children()[0]}) {
        const Vec3d place = part.T_world_mesh() * Vec3d(part.V().row(0).transpose().cast<double>());
        // Poses are products of matrices.
        EXPECT_NEAR(place.z(), 3, 1e-6);
    }
}

TEST(GltfModes, CopiesHaveThemToo) {
    Square file;
    file.add(triangles_mode, 0, {0, 1, 2});
    file.add(lines_mode, 1, {2, 3});
    const size_t places = file.floats({0, 0, 0, 5, 0, 0}, 3);
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    const MeshData mesh = node(decode(file));
    ASSERT_EQ(mesh.children.size(), 2u);
    for (size_t i = 0; i < 2; ++i) EXPECT_EQ(child(mesh, i).children.size(), 1u);
}

}  // namespace easypbr::gltf_modes_test
