// Extensions of nodes: copies, visibility, variants, pointers of animations.
#include <gtest/gtest.h>

#include <cmath>

#include <fmt/format.h>

#include "easypbr/core/memory_budget.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"

namespace easypbr::gltf_nodes_test {

namespace {

using Json = nlohmann::json;

Json& instancing(GltfBuilder& builder) {
    return builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
}

GltfBuilder two_copies() {
    GltfBuilder builder;
    builder.triangle();
    builder.json["nodes"][0]["name"] = "tree";
    builder.json["nodes"][0]["translation"] = {100, 0, 0};
    const float half = float(std::sqrt(0.5));
    instancing(builder) = {{"TRANSLATION", builder.floats({1, 2, 3, 4, 5, 6}, 3)},
                           {"ROTATION", builder.floats({0, 0, 0, 1, 0, 0, half, half}, 4)},
                           {"SCALE", builder.floats({1, 1, 1, 2, 3, 4}, 3)}};
    builder.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return builder;
}

/// A triangle with two materials to choose from.
GltfBuilder of_two_colors() {
    GltfBuilder builder;
    Json& primitive = builder.triangle();
    builder.json["materials"] = {{{"name", "grey"}}, {{"name", "red"}}, {{"name", "blue"}}};
    builder.json["extensions"]["KHR_materials_variants"]["variants"] = {
        {{"name", "Autumn"}}, {{"name", "Winter"}}, {{"name", "Night"}}};
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}},
                                                                     {{"material", 2}, {"variants", {1}}}};
    return builder;
}

std::string material_of(const io::LoadedScene& scene) {
    return node(scene).materials.at(0).name;
}

/// Two keys, at 0 and 2 seconds, for what a pointer names.
GltfBuilder pointing_at(const std::string& pointer, const std::vector<float>& values = {0, 0, 0, 6, 0, 0},
                        const std::string& interpolation = "LINEAR") {
    GltfBuilder builder;
    builder.triangle();
    const size_t input = builder.floats({0, 2}, 1), output = builder.floats(values, int(values.size() / 2));
    builder.json["animations"] = {
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels",
          {{{"sampler", 0},
            {"target",
             {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}}}}}};
    return builder;
}

}  // namespace

TEST(GltfInstances, AreCopiesThatShareTheirArrays) {
    const MeshData tree = node(decode(two_copies()));
    EXPECT_EQ(tree.V.rows(), 0);
    EXPECT_EQ(tree.name, "tree");
    EXPECT_EQ(tree.T_parent_mesh.translation(), Vec3d(100, 0, 0));
    ASSERT_EQ(tree.children.size(), 2u);
    const auto first = tree.children[0].snapshot(), second = tree.children[1].snapshot();
    EXPECT_EQ(first->V.data(), second->V.data());
    EXPECT_EQ(first->T_parent_mesh.translation(), Vec3d(1, 2, 3));
    EXPECT_EQ(first->T_parent_mesh.linear(), Mat3d::Identity());
    // Scaled, then turned by 90 degrees about z, then shifted: the vertex (1, 0, 0) and (0, 1, 0).
    EXPECT_LT((second->T_parent_mesh * Vec3d(1, 0, 0) - Vec3d(4, 7, 6)).norm(), 1e-6);
    EXPECT_LT((second->T_parent_mesh * Vec3d(0, 1, 0) - Vec3d(1, 5, 6)).norm(), 1e-6);
    EXPECT_EQ(second->name, "tree 1");
}

TEST(GltfInstances, MoveWithTheirAnimatedNode) {
    GltfBuilder builder = two_copies();
    const size_t input = builder.floats({0, 2}, 1), output = builder.floats({0, 0, 0, 6, 0, 0}, 3);
    builder.json["animations"] = {
        {{"samplers", {{{"input", input}, {"output", output}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    io::LoadedScene scene = decode(builder);
    scene.animations.apply(0, 1);
    const Mesh copy = scene.mesh.children()[0].children()[0];
    EXPECT_EQ(copy.T_world_mesh().translation(), Vec3d(4, 2, 3));
    EXPECT_EQ(copy.snapshot()->V.rows(), 3);
}

TEST(GltfInstances, MayLackSomeAttributes) {
    GltfBuilder builder;
    builder.triangle();
    // Normalised bytes, as quantised files have them: 127 is 1.
    const std::vector<int8_t> turns = {0, 0, 0, 127, 0, 0, 90, 90};
    const size_t R = builder.accessor(turns, 5120, "VEC4", 2);
    builder.json["accessors"][R]["normalized"] = true;
    instancing(builder) = {{"ROTATION", R}};
    const MeshData data = node(decode(builder));
    ASSERT_EQ(data.children.size(), 2u);
    EXPECT_LT((data.children[1].T_parent_mesh().linear() * Vec3d(1, 0, 0) - Vec3d(0, 1, 0)).norm(), 1e-6);
}

TEST(GltfInstances, RefuseBadInput) {
    const auto broken = [](auto&& change) {
        GltfBuilder builder = two_copies();
        change(builder, instancing(builder));
        return message_of(builder);
    };
    using B = GltfBuilder&;
    const std::vector<std::pair<std::string, std::string>> table = {
        {broken([](B, Json&) {}), "accepted"},
        {broken([](B, Json& a) { a = Json::object(); }), "none of TRANSLATION, ROTATION and SCALE"},
        {broken([](B b, Json& a) {
             a["SCALE"] = b.floats({1, 1, 1}, 3);
         }),
         "SCALE has 1 rows"},
        {broken([](B b, Json& a) {
             a["SCALE"] = b.floats({1, 1, 1, 1, 1, NAN}, 3);
         }),
         "SCALE is not finite"},
        {broken([](B, Json& a) { a["SCALE"] = a["ROTATION"]; }), "4 components, expected 3"},
        {broken([](B, Json& a) { a["SCALE"] = 99; }), "accessors[99] does not exist"},
        {broken([](B b, Json&) {
             b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = Json::object();
         }),
         "there are no attributes"},
    };
    for (const auto& [message, expected] : table)
        EXPECT_NE(message.find(expected), std::string::npos)
            << "expected: " << expected << "\ngot: " << message;
}

TEST(GltfInstances, AreRefusedBeyondTheLimitOnMemory) {
    GltfBuilder builder;
    builder.triangle();
    // 2^24 copies without a byte of data.
    builder.json["accessors"].push_back({{"componentType", 5126}, {"count", 1 << 24}, {"type", "VEC3"}});
    instancing(builder) = {{"TRANSLATION", builder.json["accessors"].size() - 1}};
    const std::string glb = builder.glb();
    try {
        const MemoryScope scope("test.glb", uint64_t(1) << 30);
        io::decode_gltf(as_span(glb), "test.glb");
        FAIL() << "accepted";
    } catch (const FormatError& error) {
        EXPECT_NE(std::string(error.what()).find("the copies of nodes[0] would take"), std::string::npos)
            << error.what();
    }
}

TEST(GltfVisibility, HidesANodeWithItsChildrenAndLights) {
    GltfBuilder builder;
    builder.triangle();
    builder.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"mesh", 0}, {"camera", 0}}, {{"mesh", 0}}};
    builder.json["scenes"] = {{{"nodes", {0, 2}}}};
    builder.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
    builder.json["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = true;
    builder.json["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.json["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 1;
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "dark"}},
                                                                   {{"type", "point"}, {"name", "lit"}}};
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    builder.json["extensionsRequired"] = {"KHR_node_visibility"};
    const io::LoadedScene scene = decode(builder);
    EXPECT_EQ(node(scene, 0).style.visible, false);
    EXPECT_EQ(node(scene, 0).children.at(0).snapshot()->V.rows(), 3);
    EXPECT_NE(node(scene, 1).style.visible, false);
    EXPECT_FALSE(scene.lights.contains("dark"));
    EXPECT_TRUE(scene.lights.contains("lit"));
    EXPECT_EQ(scene.cameras.size(), 1u);
    builder.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = 3;
    EXPECT_NE(message_of(builder).find("'visible' must be true or false"), std::string::npos);
}

TEST(GltfVariants, ChooseTheMaterialsByName) {
    const GltfBuilder builder = of_two_colors();
    EXPECT_EQ(decode(builder).variants, (std::vector<std::string>{"Autumn", "Winter", "Night"}));
    EXPECT_EQ(material_of(decode(builder)), "grey");
    EXPECT_EQ(material_of(decode(builder, "Autumn")), "red");
    EXPECT_EQ(material_of(decode(builder, "Winter")), "blue");
    // It maps nothing: the primitive's own.
    EXPECT_EQ(material_of(decode(builder, "Night")), "grey");
}

TEST(GltfVariants, AreToldWhenTheyAreMissing) {
    const GltfBuilder builder = of_two_colors();
    try {
        decode(builder, "winter");
        FAIL() << "accepted";
    } catch (const NameError& error) {
        EXPECT_EQ(
            std::string(error.what()),
            "test.glb has no material variant 'winter' (did you mean 'Winter'?): it has Autumn, Winter, "
            "Night");
    }
    GltfBuilder plain;
    plain.triangle();
    const LogCapture log;
    EXPECT_EQ(node(io::load_scene(as_span(plain.glb()), "test.glb", {.variant = "Winter"})).V.rows(), 3);
    EXPECT_EQ(log.text, "test.glb has no material variants: 'Winter' changes nothing\n");
}

TEST(GltfVariants, RefuseBadInput) {
    GltfBuilder builder = of_two_colors();
    Json& given = builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"];
    given["mappings"][0]["material"] = 7;
    EXPECT_EQ(message_of(builder), "accepted");  // what is not chosen is not looked at
    EXPECT_THROW(decode(builder, "Autumn"), FormatError);
    given["mappings"] = 3;
    EXPECT_THROW(decode(builder, "Autumn"), FormatError);
    builder.json["extensions"]["KHR_materials_variants"]["variants"] = 3;
    EXPECT_THROW(decode(builder), FormatError);
}

TEST(GltfAnimationPointer, MovesWhatANodeHas) {
    io::LoadedScene scene = decode(pointing_at("/nodes/0/translation"));
    const LogCapture log;
    scene.animations.apply(0, 0.5);
    EXPECT_EQ(scene.mesh.children()[0].T_world_mesh().translation(), Vec3d(1.5, 0, 0));
    EXPECT_EQ(log.text, "");
}

/// With a material of whatever may be animated.
GltfBuilder material_at(const std::string& property, const std::vector<float>& values) {
    GltfBuilder builder = pointing_at("/materials/0/" + property, values);
    builder.json["meshes"][0]["primitives"][0]["material"] = 0;
    builder.json["materials"] = {
        {{"emissiveFactor", {0.5, 0.25, 1.0}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2.0}}}}}}};
    return builder;
}

Material material_after(const GltfBuilder& builder, double time_s) {
    io::LoadedScene scene = decode(builder);
    scene.animations.apply(0, time_s, false);
    return scene.mesh.children()[0].snapshot()->materials.at(0);
}

// Half way between the keys of 0 and 1 each factor is a half.
TEST(GltfAnimationPointer, ChangesTheNumbersOfMaterials) {
    const std::string ext = "extensions/KHR_materials_";
    const std::vector<std::pair<std::string, float Material::*>> numbers = {
        {"pbrMetallicRoughness/metallicFactor", &Material::metallic},
        {"pbrMetallicRoughness/roughnessFactor", &Material::roughness},
        {"alphaCutoff", &Material::alpha_cutoff},
        {"normalTexture/scale", &Material::normal_scale},
        {"occlusionTexture/strength", &Material::occlusion_strength},
        {ext + "clearcoat/clearcoatFactor", &Material::clearcoat},
        {ext + "clearcoat/clearcoatRoughnessFactor", &Material::clearcoat_roughness},
        {ext + "clearcoat/clearcoatNormalTexture/scale", &Material::clearcoat_normal_scale},
        {ext + "sheen/sheenRoughnessFactor", &Material::sheen_roughness},
        {ext + "specular/specularFactor", &Material::specular},
        {ext + "transmission/transmissionFactor", &Material::transmission},
        {ext + "volume/thicknessFactor", &Material::thickness},
        {ext + "volume/attenuationDistance", &Material::attenuation_distance},
        {ext + "dispersion/dispersion", &Material::dispersion},
        {ext + "iridescence/iridescenceFactor", &Material::iridescence},
        {ext + "iridescence/iridescenceThicknessMinimum", &Material::iridescence_thickness_min},
        {ext + "iridescence/iridescenceThicknessMaximum", &Material::iridescence_thickness_max},
        {ext + "anisotropy/anisotropyStrength", &Material::anisotropy}};
    for (const auto& [property, value] : numbers)
        EXPECT_EQ(material_after(material_at(property, {0, 1}), 1).*value, 0.5f) << property;
    EXPECT_EQ(material_after(material_at(ext + "ior/ior", {1, 2}), 1).ior, 1.5f);
    EXPECT_EQ(material_after(material_at(ext + "iridescence/iridescenceIor", {1, 2}), 1).iridescence_ior,
              1.5f);
    const Material turned =
        material_after(material_at(ext + "anisotropy/anisotropyRotation", {0, float(pi)}), 1);
    EXPECT_NEAR(turned.anisotropy_rotation_deg, 90, 1e-5);
}

TEST(GltfAnimationPointer, ChangesTheColorsOfMaterials) {
    const std::string ext = "extensions/KHR_materials_";
    const Material base =
        material_after(material_at("pbrMetallicRoughness/baseColorFactor", {0, 0, 0, 0, 1, 0.5, 0.25, 1}), 1);
    EXPECT_EQ(base.base_color, Vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(base.opacity, 0.5f);
    const std::vector<float> keys = {0, 0, 0, 1, 0.5, 0.25};
    EXPECT_EQ(material_after(material_at(ext + "sheen/sheenColorFactor", keys), 1).sheen_color,
              Vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(material_after(material_at(ext + "specular/specularColorFactor", keys), 1).specular_color,
              Vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(material_after(material_at(ext + "volume/attenuationColor", keys), 1).attenuation_color,
              Vec3(0.5f, 0.25f, 0.125f));
    // Factor and strength multiply, whichever of them is animated.
    EXPECT_EQ(material_after(material_at("emissiveFactor", keys), 1).emissive, Vec3(1, 0.5f, 0.25f));
    EXPECT_EQ(material_after(material_at(ext + "emissive_strength/emissiveStrength", {0, 8}), 1).emissive,
              Vec3(2, 1, 4));
}

// What is outside of the range is drawn at its end, and after another animation all is at rest again.
TEST(GltfAnimationPointer, KeepsMaterialsInRangeAndPutsThemBack) {
    GltfBuilder builder = material_at("pbrMetallicRoughness/roughnessFactor", {0.5, 3});
    Json other = builder.json["animations"][0];
    other["channels"][0]["target"]["extensions"]["KHR_animation_pointer"]["pointer"] =
        "/materials/0/pbrMetallicRoughness/metallicFactor";
    builder.json["animations"].push_back(other);
    io::LoadedScene scene = decode(builder);
    const auto material = [&] { return scene.mesh.children()[0].snapshot()->materials.at(0); };
    scene.animations.apply(0, 0, false);
    EXPECT_EQ(material().roughness, 0.5f);
    scene.animations.apply(0, 2, false);
    EXPECT_EQ(material().roughness, 1.0f);
    EXPECT_EQ(material().metallic, 1.0f);
    scene.animations.apply(1, 0, false);
    EXPECT_EQ(material().roughness, 1.0f);
    EXPECT_EQ(material().metallic, 0.5f);
}

// The specification's matrix, translation * rotation * scale, where v goes down.
TEST(GltfAnimationPointer, MovesTextures) {
    const std::string texture = "pbrMetallicRoughness/baseColorTexture";
    const auto at = [&](const std::string& part, const std::vector<float>& keys, const Vec2& uv) {
        const Material m =
            material_after(material_at(texture + "/extensions/KHR_texture_transform/" + part, keys), 1);
        const Vec3 moved = m.base_color_texture.uv_transform * Vec3(uv.x(), 1 - uv.y(), 1);
        return Vec2(moved.x(), 1 - moved.y());
    };
    EXPECT_TRUE(at("offset", {0, 0, 0.5, 1}, {0.25f, 0.5f}).isApprox(Vec2(0.5f, 1.0f)));
    EXPECT_TRUE(at("scale", {1, 1, 3, 5}, {0.25f, 0.5f}).isApprox(Vec2(0.5f, 1.5f)));
    EXPECT_TRUE(at("rotation", {0, float(pi)}, {1, 0}).isApprox(Vec2(0, -1), 1e-6f));
}

// Each copy of a node has the material.
TEST(GltfAnimationPointer, ChangesTheMaterialsOfCopies) {
    GltfBuilder builder = material_at("pbrMetallicRoughness/roughnessFactor", {0, 1});
    instancing(builder) = {{"TRANSLATION", builder.floats({1, 2, 3, 4, 5, 6}, 3)}};
    io::LoadedScene scene = decode(builder);
    scene.animations.apply(0, 1);
    for (const Mesh& copy : scene.mesh.children()[0].children())
        EXPECT_EQ(copy.snapshot()->materials.at(0).roughness, 0.5f);
}

TEST(GltfAnimationPointer, ShowsAndHidesNodes) {
    const std::string pointer = "/nodes/0/extensions/KHR_node_visibility/visible";
    io::LoadedScene scene = decode(pointing_at(pointer, {1, 0}, "STEP"));
    const auto visible = [&] { return scene.mesh.children()[0].style().visible.value(); };
    scene.animations.apply(0, 1, false);
    EXPECT_TRUE(visible().value_or(true));
    scene.animations.apply(0, 2, false);
    EXPECT_EQ(visible(), false);
    scene.animations.apply(0, 0, false);
    EXPECT_EQ(visible(), true);
    EXPECT_NE(
        message_of(pointing_at(pointer, {1, 0})).find("visibility of nodes[0] by a sampler that is not"),
        std::string::npos);
    EXPECT_NE(message_of(pointing_at(pointer, {1, 0, 1, 0}, "STEP")), "accepted");
}

TEST(GltfAnimationPointer, WarnsOfWhatCannotBeAnimated) {
    for (const char* pointer :
         {"/materials/0/doubleSided", "/materials/x/alphaCutoff", "/materials/0",
          "/materials/0/normalTexture/extensions/KHR_texture_transform/texCoord", "/nodes/0",
          "/nodes/x/translation", "/nodes//translation", "", "/nodes/0/weights/1", "/nodes/-1/translation"}) {
        const LogCapture log;
        GltfBuilder builder = pointing_at(pointer);
        builder.json["materials"] = {Json::object()};
        decode(builder);
        EXPECT_NE(log.text.find(fmt::format("animates '{}', which cannot be animated", pointer)),
                  std::string::npos)
            << pointer << ": " << log.text;
    }
    EXPECT_NE(message_of(pointing_at("/nodes/5/translation")).find("nodes[5] does not exist"),
              std::string::npos);
    EXPECT_NE(message_of(pointing_at("/nodes/99999999999999999999/scale")), "");
    EXPECT_NE(message_of(pointing_at("/materials/5/alphaCutoff", {0, 1})).find("materials[5] does not exist"),
              std::string::npos);
    GltfBuilder without = pointing_at("");
    without.json["animations"][0]["channels"][0]["target"].erase("extensions");
    EXPECT_NE(message_of(without).find("without a pointer"), std::string::npos);
}

TEST(GltfExtensions, WhatIsNotKnownIsNamed) {
    GltfBuilder builder;
    builder.triangle();
    builder.json["extensionsUsed"] = {"KHR_materials_diffuse_transmission", "EXT_mesh_gpu_instancing"};
    const LogCapture log;
    decode(builder);
    EXPECT_EQ(
        log.text,
        "test.glb: the extension KHR_materials_diffuse_transmission is not known; it is drawn without\n");
}

}  // namespace easypbr::gltf_nodes_test
