#include <fmt/format.h>
#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_builder.h"
#include "test_data.h"

namespace easypbr::io::gltf_animation_test {
namespace {

LoadedScene load(const GltfBuilder& file) {
    const std::string glb = file.glb();
    return decode_gltf(as_span(glb), "moving.glb");
}

std::string error_of(const GltfBuilder& file) {
    try {
        load(file);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

/// A triangle whose node goes from x = 0 to x = 6 in two seconds.
GltfBuilder moving() {
    GltfBuilder file;
    file.triangle();
    const size_t input = file.floats({0, 2}, 1), output = file.floats({0, 0, 0, 6, 0, 0}, 3);
    file.json["animations"] = {
        {{"name", "go"},
         {"samplers", {{{"input", input}, {"output", output}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    return file;
}

TEST(GltfAnimation, MovesNodes) {
    LoadedScene scene = load(moving());
    ASSERT_EQ(scene.animations.names(), std::vector<std::string>{"go"});
    EXPECT_EQ(scene.animations.duration_s(0), 2);
    scene.animations.apply(0, 0.5);
    EXPECT_EQ(scene.mesh.children()[0].T_world_mesh().translation(), Vec3d(1.5, 0, 0));
    EXPECT_TRUE(load([] {
                    GltfBuilder still;
                    still.triangle();
                    return still;
                }())
                    .animations.empty());
}

// Two joints, one of them at x = 1 below the other; the second turns by 90 degrees about z. A vertex at (2,
// 0, 0) that follows it goes to (1, 1, 0).
TEST(GltfAnimation, BendsSkins) {
    GltfBuilder file;
    nlohmann::json& primitive = file.triangle();
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 2, 0, 0};
    const size_t position = file.floats(positions, 3);
    const size_t joints =
        file.accessor(std::vector<uint8_t>{0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, 5121, "VEC4", 3);
    const size_t weights = file.floats({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0}, 4);
    primitive["attributes"] = {{"POSITION", position}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}};
    const std::vector<float> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    const size_t matrices = file.accessor(bind, 5126, "MAT4", 2);
    file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {1, 0, 0}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    const float half = float(std::sqrt(0.5));
    const size_t input = file.floats({0, 1}, 1), output = file.floats({0, 0, 0, 1, 0, 0, half, half}, 4);
    file.json["animations"] = {
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}}};
    LoadedScene scene = load(file);
    const Mesh mesh = scene.mesh.children()[0];
    EXPECT_EQ(mesh.V()(2, 0), 2) << "at rest";
    scene.animations.apply(scene.animations.find("animations[0]"), 1, false);
    const Array3f::Dense expected{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    EXPECT_LT((mesh.V() - expected).cwiseAbs().maxCoeff(), 1e-6f);
}

// Twelve joints at z = 0, 1, ..., 11, each with a weight of 1/12: all vertices are lifted by 5.5.
TEST(GltfAnimation, VerticesFollowAllSetsOfJoints) {
    GltfBuilder file;
    nlohmann::json& primitive = file.triangle();
    nlohmann::json attributes = primitive["attributes"];
    const size_t weights = file.floats(std::vector<float>(12, 1.0f / 12), 4);
    for (uint8_t set = 0; set < 3; ++set) {
        std::vector<uint8_t> joints;
        for (int i = 0; i < 12; ++i) joints.push_back(uint8_t(4 * set + i % 4));
        attributes[fmt::format("JOINTS_{}", set)] = file.accessor(joints, 5121, "VEC4", 3);
        attributes[fmt::format("WEIGHTS_{}", set)] = weights;
    }
    file.json["meshes"][0]["primitives"][0]["attributes"] = attributes;
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}};
    nlohmann::json& joints = file.json["skins"][0]["joints"];
    file.json["scenes"][0]["nodes"] = {0};
    for (int k = 0; k < 12; ++k) {
        file.json["nodes"].push_back({{"translation", {0, 0, k}}});
        file.json["scenes"][0]["nodes"].push_back(k + 1);
        joints.push_back(k + 1);
    }
    const Mesh mesh = load(file).mesh.children()[0];
    const Vec3d place = mesh.T_world_mesh() * Vec3d(mesh.V().row(0).transpose().cast<double>());
    // A sum of twelve rounded weights.
    EXPECT_NEAR(place.z(), 5.5, 1e-5);
}

TEST(GltfAnimation, MorphsBySplines) {
    GltfBuilder file;
    nlohmann::json& primitive = file.triangle();
    const size_t lifted = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3),
                 widened = file.floats({0, 0, 0, 1, 0, 0, 0, 0, 0}, 3);
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", lifted}}, {{"POSITION", widened}}};
    file.json["meshes"][0]["weights"] = {0.25, 0};
    (void)primitive;
    // Two targets, keys of in-tangents, values and out-tangents; without tangents half way is the mean.
    const size_t input = file.floats({0, 1}, 1),
                 output = file.floats({0, 0, 0, 0, 0, 0, 0, 0, 1, 4, 0, 0}, 1);
    file.json["animations"] = {
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", "CUBICSPLINE"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    LoadedScene scene = load(file);
    EXPECT_EQ(scene.mesh.children()[0].V(), (Array3f::Dense{{0, 0, 0.25}, {1, 0, 0.25}, {0, 1, 0.25}}));
    scene.animations.apply(0, 0.5);
    const Array3f::Dense expected{{0, 0, 0.5}, {3, 0, 0.5}, {0, 1, 0.5}};
    EXPECT_LT((scene.mesh.children()[0].V() - expected).cwiseAbs().maxCoeff(), 1e-6f);
}

/// The triangle with one morph target, which lifts it by 1, of weight 1/2.
GltfBuilder lifted() {
    GltfBuilder file;
    file.triangle();
    const size_t target = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
    file.json["meshes"][0]["weights"] = {0.5};
    return file;
}

float height_of(const Mesh& mesh) {
    EXPECT_EQ(mesh.V().col(2).minCoeff(), mesh.V().col(2).maxCoeff());
    return mesh.V()(0, 2);
}

// glTF 2.0, section 3.7.2.2: the weights of a mesh, or in their place those of its node, are the state
// without an animation.
TEST(GltfAnimation, WeightsOfTheFileAreThoseAtRest) {
    GltfBuilder file = lifted();
    EXPECT_TRUE(load(file).animations.empty());
    EXPECT_EQ(height_of(load(file).mesh.children()[0]), 0.5f);
    file.json["nodes"] = {{{"mesh", 0}, {"weights", {0.25}}}, {{"mesh", 0}}, {{"mesh", 0}, {"weights", {0}}}};
    file.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
    const LoadedScene scene = load(file);
    EXPECT_EQ(height_of(scene.mesh.children()[0]), 0.25f);
    EXPECT_EQ(height_of(scene.mesh.children()[1]), 0.5f);
    EXPECT_EQ(height_of(scene.mesh.children()[2]), 0.0f);
}

TEST(GltfAnimation, WhatAnAnimationLeavesAloneKeepsItsWeights) {
    GltfBuilder file = lifted();
    const size_t input = file.floats({0, 2}, 1), output = file.floats({0, 0, 0, 6, 0, 0}, 3);
    file.json["animations"] = {
        {{"samplers", {{{"input", input}, {"output", output}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    LoadedScene scene = load(file);
    EXPECT_EQ(height_of(scene.mesh.children()[0]), 0.5f);
    for (const double seconds : {0.0, 1.0}) {
        scene.animations.apply(0, seconds);
        EXPECT_EQ(height_of(scene.mesh.children()[0]), 0.5f) << "once, not again";
    }
}

// Section 3.11: as many values as keys times morph targets.
TEST(GltfAnimation, WeightsMustBeOnePerTarget) {
    GltfBuilder file = lifted();
    nlohmann::json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["targets"].push_back(primitive["targets"][0]);
    file.json["meshes"][0]["weights"] = {0.5, 0};
    const size_t input = file.floats({0, 2}, 1);
    const auto with_values = [&](const std::vector<float>& values) {
        GltfBuilder whole = file;
        whole.json["animations"] = {
            {{"samplers", {{{"input", input}, {"output", whole.floats(values, 1)}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
        return whole;
    };
    EXPECT_EQ(error_of(with_values({0, 1, 0, 1})), "no error");
    for (const size_t count : {2, 3, 6}) {
        const std::string error = error_of(with_values(std::vector<float>(count, 0)));
        EXPECT_NE(error.find("has 2 keys of 2 weights, but accessors["), std::string::npos) << error;
    }
    GltfBuilder without = with_values({0, 1});
    without.json["meshes"][0]["primitives"][0].erase("targets");
    without.json["meshes"][0].erase("weights");
    EXPECT_EQ(load(without).animations.duration_s(0), 0) << "left out";
}

// Section 3.7.3.3: a skinned mesh ignores its node's transform. One joint at y = 5 without an inverse bind
// matrix; the node at x = 100.
TEST(GltfAnimation, SkinsFollowTheirJointsWithoutAnAnimation) {
    GltfBuilder file;
    nlohmann::json& attributes = file.triangle()["attributes"];
    attributes["JOINTS_0"] = file.accessor(std::vector<uint8_t>(12, 0), 5121, "VEC4", 3);
    attributes["WEIGHTS_0"] = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                          {{"translation", {0, 5, 0}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    file.json["skins"] = {{{"joints", {1}}}};
    const LoadedScene scene = load(file);
    EXPECT_TRUE(scene.animations.empty());
    const Mesh mesh = scene.mesh.children()[0];
    // In the world (0, 5, 0), (1, 5, 0) and (0, 6, 0): small integers are exact.
    const Eigen::Matrix3d V = mesh.V().transpose().cast<double>();
    EXPECT_EQ((mesh.T_world_mesh() * V), (Eigen::Matrix3d{{0, 1, 0}, {5, 5, 6}, {0, 0, 0}}));
    file.json["skins"] = {{{"joints", {7}}}};
    EXPECT_NE(error_of(file).find("nodes[7]"), std::string::npos) << error_of(file);
}

TEST(GltfAnimation, SaysWhatIsWrong) {
    GltfBuilder file = moving();
    file.json["animations"][0]["samplers"][0]["input"] = file.floats({2, 2}, 1);
    EXPECT_NE(error_of(file).find("do not rise"), std::string::npos) << error_of(file);
    file = moving();
    file.json["animations"][0]["samplers"][0]["interpolation"] = "MAGIC";
    EXPECT_NE(error_of(file).find("unknown interpolation 'MAGIC'"), std::string::npos);
    file = moving();
    file.json["animations"][0]["samplers"][0]["output"] = file.floats({0, 0, 0}, 3);
    EXPECT_NE(error_of(file).find("has 2 keys, but accessors["), std::string::npos) << error_of(file);
    file = moving();
    file.json["animations"][0]["channels"][0]["target"]["node"] = 5;
    EXPECT_NE(error_of(file).find("nodes[5]"), std::string::npos);
    file = moving();
    file.json["animations"][0]["channels"][0]["sampler"] = 1;
    EXPECT_NE(error_of(file).find("has no sampler 1"), std::string::npos);
    file = moving();
    file.json["animations"][0]["channels"][0]["target"]["path"] = "colour";
    EXPECT_TRUE(load(file).animations.duration_s(0) == 0) << "what is not known is left out";
    file = moving();
    file.json["skins"] = {{{"joints", {0, 9}}}};
    EXPECT_NE(error_of(file).find("nodes[9]"), std::string::npos);
}

}  // namespace
}  // namespace easypbr::io::gltf_animation_test
