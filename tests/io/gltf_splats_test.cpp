// Splats in glTF: KHR_gaussian_splatting. The files are made here, value by value.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "easypbr/io/archive/deflate.h"
#include "easypbr/io/mesh/gltf/glb_writer.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/gltf_builder.h"
#include "io/packed_splats.h"
#include "refusal.h"

namespace easypbr::gltf_splats_test {
namespace {

using namespace packed_splats;

nlohmann::json& splat_primitive(GltfBuilder& builder, int degree) {
    nlohmann::json attributes;
    attributes["POSITION"] = builder.floats({1, 2, 3, 4, 5, 6}, 3);
    const std::string name = "KHR_gaussian_splatting:";
    attributes[name + "ROTATION"] = builder.floats({1, 0, 0, 0, 0, 0, 0, 1}, 4);
    attributes[name + "SCALE"] = builder.floats({0.1f, 0.2f, 0.3f, 0, 1, 2}, 3);
    attributes[name + "OPACITY"] = builder.floats({0.25f, 1}, 1);
    for (int l = 0; l <= degree; ++l)
        for (int k = 0; k <= 2 * l; ++k) {
            const auto value = float(10 * l + k);
            attributes[name + "SH_DEGREE_" + std::to_string(l) + "_COEF_" + std::to_string(k)] =
                builder.floats({value, value + 0.1f, value + 0.2f, -value, 0, 0}, 3);
        }
    builder.json["extensionsUsed"] = {"KHR_gaussian_splatting"};
    if (!builder.json.contains("meshes"))
        builder.json["meshes"] = {{{"name", "m"}, {"primitives", nlohmann::json::array()}}};
    auto& primitives = builder.json["meshes"][0]["primitives"];
    primitives.push_back(
        {{"attributes", attributes},
         {"mode", 0},
         {"extensions",
          {{"KHR_gaussian_splatting", {{"kernel", "ellipse"}, {"colorSpace", "srgb_rec709_display"}}}}}});
    return primitives.back();
}

MeshData node_of(const GltfBuilder& builder) {
    const auto scene = io::decode_gltf(as_span(builder.glb()), "test.glb");
    return *scene.mesh.snapshot()->children.at(0).snapshot();
}

TEST(GltfSplats, OfAllDegrees) {
    for (int degree = 0; degree <= 3; ++degree) {
        GltfBuilder builder;
        splat_primitive(builder, degree);
        const MeshData mesh = node_of(builder);
        validate(mesh);
        ASSERT_EQ(mesh.V.rows(), 2);
        ASSERT_EQ(mesh.splats.degree(), degree);
        EXPECT_EQ(mesh.V(1, 2), 6);
        EXPECT_EQ(mesh.splats.scales(0, 2), 0.3f);
        EXPECT_EQ(mesh.splats.rotations.row(0), Eigen::RowVector4f(0, 1, 0, 0));
        EXPECT_EQ(mesh.splats.rotations.row(1), Eigen::RowVector4f(1, 0, 0, 0));
        EXPECT_EQ(mesh.splats.opacities(0), 0.25f);
        const int last = 3 * (degree + 1) * (degree + 1) - 1;
        EXPECT_FLOAT_EQ(mesh.splats.sh(0, last), float(12 * degree) + 0.2f);
    }
}

TEST(GltfSplats, WithTrianglesHasThemAsChild) {
    GltfBuilder builder;
    builder.triangle();
    splat_primitive(builder, 0);
    const MeshData mesh = node_of(builder);
    EXPECT_EQ(mesh.F.rows(), 1);
    EXPECT_TRUE(mesh.splats.empty());
    ASSERT_EQ(mesh.children.size(), 1u);
    EXPECT_EQ(mesh.children.at(0).snapshot()->splats.scales.rows(), 2);
}

TEST(GltfSplats, OfLinearColorsIsEncoded) {
    GltfBuilder builder;
    auto& primitive = splat_primitive(builder, 0);
    primitive["extensions"]["KHR_gaussian_splatting"]["colorSpace"] = "lin_rec709_display";
    // 0.5 + constant * 0.1, encoded.
    const double linear = 0.5 + constant * 0.1, encoded = 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    EXPECT_NEAR(0.5 + constant * double(node_of(builder).splats.sh(0, 1)), encoded, 1e-5);
}

TEST(GltfSplats, MayHoldSpz) {
    GltfBuilder builder;
    const std::string spz = io::gzip(spz_content(2).str());
    auto& primitive = splat_primitive(builder, 0);
    primitive["attributes"] = {{"POSITION", primitive["attributes"]["POSITION"]}};
    primitive["extensions"]["KHR_gaussian_splatting"]["extensions"] = {
        {"KHR_gaussian_splatting_compression_spz_2",
         {{"bufferView", builder.view(std::vector<char>(spz.begin(), spz.end()))}}}};
    builder.json["extensionsRequired"] = {"KHR_gaussian_splatting_compression_spz_2"};
    EXPECT_EQ(node_of(builder).splats.degree(), 1);
}

TEST(GltfSplats, DamagedSaysWhy) {
    const auto said = [](auto&& damage) {
        GltfBuilder builder;
        damage(splat_primitive(builder, 1), builder);
        return refusal<Error>([&] { node_of(builder); });
    };
    const std::string name = "KHR_gaussian_splatting:";
    using Json = nlohmann::json;
    EXPECT_TRUE(has(said([](Json& p, GltfBuilder&) { p["mode"] = 4; }), "POINTS"));
    for (const std::string part :
         {"ROTATION", "SCALE", "OPACITY", "SH_DEGREE_0_COEF_0", "SH_DEGREE_1_COEF_1"})
        EXPECT_TRUE(has(said([&](Json& p, GltfBuilder&) { p["attributes"].erase(name + part); }), part))
            << part;
    EXPECT_TRUE(has(said([&](Json& p, GltfBuilder& builder) {
                        p["attributes"][name + "SCALE"] = builder.floats({1, 1, 1}, 3);
                    }),
                    "2 splats"));
    EXPECT_TRUE(has(said([&](Json& p, GltfBuilder& builder) {
                        p["attributes"][name + "OPACITY"] = builder.floats({1, 1.5f}, 1);
                    }),
                    "opacities"));
    EXPECT_TRUE(has(said([&](Json& p, GltfBuilder& builder) {
                        p["attributes"][name + "SCALE"] = builder.floats({1, 1, 1, 1, -1, 1}, 3);
                    }),
                    "splat 1 of 2"));
}

TEST(GltfSplats, WrittenGlbIsTheSame) {
    const MeshData mesh = various_splats(5);
    const std::string glb = io::encode_glb(Mesh(mesh));
    const auto scene = io::decode_gltf(as_span(glb), "test.glb");
    const MeshData back = *scene.mesh.snapshot()->children.at(0).snapshot();
    EXPECT_EQ(back.V, mesh.V);
    EXPECT_EQ(back.splats.scales, mesh.splats.scales);
    EXPECT_EQ(back.splats.opacities, mesh.splats.opacities);
    EXPECT_EQ(back.splats.sh, mesh.splats.sh);
    // Normalised in single precision.
    EXPECT_LE(largest_turn(back.splats.rotations, mesh.splats.rotations), 1e-6f);
}

}  // namespace
}  // namespace easypbr::gltf_splats_test
