// The material extensions of glTF: each read from a small file, written, and read again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/gltf/glb_writer.h"
#include "easypbr/io/mesh/gltf/gltf_reader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"

namespace easypbr::gltf_extensions_test {

namespace {

using Json = nlohmann::json;

/// Index of a new texture of 2 x 2 pixels, all of these channels.
size_t add_texture(GltfBuilder& builder, std::initializer_list<uint8_t> channels) {
    Image image(2, 2, int(channels.size()), PixelType::u8);
    for (size_t i = 0; i < 4; ++i)
        std::copy(channels.begin(), channels.end(), image.pixels<uint8_t>().data() + i * channels.size());
    const auto png = io::encode_png(image);
    const std::vector<char> bytes(reinterpret_cast<const char*>(png.data()),
                                  reinterpret_cast<const char*>(png.data()) + png.size());
    builder.json["images"].push_back({{"bufferView", builder.view(bytes)}, {"mimeType", "image/png"}});
    builder.json["textures"].push_back({{"source", builder.json["images"].size() - 1}});
    return builder.json["textures"].size() - 1;
}

Material material_of(const io::LoadedScene& scene) {
    return scene.mesh.snapshot()->children.at(0).snapshot()->materials.at(0);
}

/// The material of a file whose only triangle has one with these extensions.
Material read(GltfBuilder& builder, const Json& extensions) {
    builder.triangle()["material"] = 0;
    builder.json["materials"] = {{{"name", "m"}, {"extensions", extensions}}};
    for (const auto& [name, value] : extensions.items()) builder.json["extensionsUsed"].push_back(name);
    return material_of(io::decode_gltf(as_span(builder.glb()), "test.glb"));
}

Material read(const Json& extensions) {
    GltfBuilder builder;
    return read(builder, extensions);
}

/// The value that a shader would read from the texture's first pixel.
int value_at(const Texture& texture) {
    return texture.image->at<uint8_t>(0, 0)[texture.channel];
}

/// Written as GLB and read again.
Material written(const Material& material) {
    MeshData data;
    data.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    data.F = Array3i(Array3i::Dense{{0, 1, 2}});
    data.UV = Array2f(Array2f::Dense{{0, 0}, {1, 0}, {0, 1}});
    data.materials = {material};
    return material_of(io::decode_gltf(as_span(io::encode_glb(Mesh(data))), "test.glb"));
}

void expect_same_values(const Material& a, const Material& b) {
    for (const MaterialNumber& number : material_numbers()) {
        const float x = a.*number.value, y = b.*number.value;
        // Degrees go through radians: a rounding of each. All else is written as it is.
        EXPECT_TRUE(x == y || std::abs(x - y) <= 4e-7f * std::abs(x)) << number.name << " " << x << " " << y;
    }
    for (const MaterialColor& color : material_colors())
        EXPECT_EQ(a.*color.value, b.*color.value) << color.name;
    for (const MaterialTexture& use : material_textures()) {
        const Texture &x = a.*use.texture, &y = b.*use.texture;
        ASSERT_EQ(bool(x), bool(y)) << use.name;
        if (x) {
            EXPECT_EQ(value_at(x), value_at(y)) << use.name;
        }
    }
}

TEST(GltfExtensions, WithoutThemAMaterialIsNotExtended) {
    EXPECT_FALSE(read(Json::object()).is_extended());
    EXPECT_FALSE(Material().is_extended());
}

TEST(GltfExtensions, Clearcoat) {
    GltfBuilder builder;
    const size_t factor = add_texture(builder, {10, 20, 30}), rough = add_texture(builder, {40, 50, 60}),
                 normal = add_texture(builder, {128, 128, 255});
    const Material m = read(builder, {{"KHR_materials_clearcoat",
                                       {{"clearcoatFactor", 0.5},
                                        {"clearcoatRoughnessFactor", 0.25},
                                        {"clearcoatTexture", {{"index", factor}}},
                                        {"clearcoatRoughnessTexture", {{"index", rough}}},
                                        {"clearcoatNormalTexture", {{"index", normal}, {"scale", 0.75}}}}}});
    EXPECT_EQ(m.clearcoat, 0.5f);
    EXPECT_EQ(m.clearcoat_roughness, 0.25f);
    EXPECT_EQ(m.clearcoat_normal_scale, 0.75f);
    EXPECT_EQ(value_at(m.clearcoat_texture), 10);            // red
    EXPECT_EQ(value_at(m.clearcoat_roughness_texture), 50);  // green
    EXPECT_TRUE(bool(m.clearcoat_normal_texture));
    EXPECT_TRUE(m.is_extended());
    expect_same_values(m, written(m));
}

TEST(GltfExtensions, Sheen) {
    GltfBuilder builder;
    const size_t both = add_texture(builder, {10, 20, 30, 40});
    const Material m = read(builder, {{"KHR_materials_sheen",
                                       {{"sheenColorFactor", {0.25, 0.5, 1.0}},
                                        {"sheenRoughnessFactor", 0.5},
                                        {"sheenColorTexture", {{"index", both}}},
                                        {"sheenRoughnessTexture", {{"index", both}}}}}});
    EXPECT_EQ(m.sheen_color, Vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(m.sheen_roughness, 0.5f);
    EXPECT_EQ(value_at(m.sheen_color_texture), 10);
    EXPECT_EQ(value_at(m.sheen_roughness_texture), 40);  // alpha
    EXPECT_TRUE(m.is_extended());
    expect_same_values(m, written(m));
}

TEST(GltfExtensions, SpecularAndIor) {
    GltfBuilder builder;
    const size_t both = add_texture(builder, {10, 20, 30, 40});
    const Material m = read(builder, {{"KHR_materials_specular",
                                       {{"specularFactor", 0.5},
                                        {"specularColorFactor", {2.0, 1.0, 0.5}},
                                        {"specularTexture", {{"index", both}}},
                                        {"specularColorTexture", {{"index", both}}}}},
                                      {"KHR_materials_ior", {{"ior", 1.75}}}});
    EXPECT_EQ(m.specular, 0.5f);
    EXPECT_EQ(m.specular_color, Vec3(2, 1, 0.5f));  // more than 1 is allowed
    EXPECT_EQ(value_at(m.specular_texture), 40);    // alpha
    EXPECT_EQ(value_at(m.specular_color_texture), 10);
    EXPECT_EQ(m.ior, 1.75f);
    EXPECT_TRUE(m.is_extended());
    expect_same_values(m, written(m));
    EXPECT_EQ(read({{"KHR_materials_ior", {{"ior", 0}}}}).ior, 0.0f);
}

TEST(GltfExtensions, TransmissionAndVolume) {
    GltfBuilder builder;
    const size_t both = add_texture(builder, {10, 20, 30});
    const Material m =
        read(builder, {{"KHR_materials_transmission",
                        {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", both}}}}},
                       {"KHR_materials_volume",
                        {{"thicknessFactor", 0.5},
                         {"thicknessTexture", {{"index", both}}},
                         {"attenuationDistance", 2.0},
                         {"attenuationColor", {0.25, 0.5, 1.0}}}}});
    EXPECT_EQ(m.transmission, 0.75f);
    EXPECT_EQ(value_at(m.transmission_texture), 10);
    EXPECT_EQ(m.thickness, 0.5f);
    EXPECT_EQ(value_at(m.thickness_texture), 20);
    EXPECT_EQ(m.attenuation_distance, 2.0f);
    EXPECT_EQ(m.attenuation_color, Vec3(0.25f, 0.5f, 1));
    EXPECT_TRUE(m.transmits());
    expect_same_values(m, written(m));
    // Without a distance nothing is absorbed.
    const Material clear = read({{"KHR_materials_volume", {{"thicknessFactor", 1.0}}}});
    EXPECT_TRUE(std::isinf(clear.attenuation_distance));
    expect_same_values(clear, written(clear));
}

TEST(GltfExtensions, Dispersion) {
    const Json volume = {{"thicknessFactor", 1.0}};
    const Material m = read({{"KHR_materials_dispersion", {{"dispersion", 0.5}}},
                             {"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                             {"KHR_materials_volume", volume}});
    EXPECT_EQ(m.dispersion, 0.5f);
    expect_same_values(m, written(m));
    EXPECT_EQ(read({{"KHR_materials_dispersion", Json::object()}}).dispersion, 0.0f);
}

TEST(GltfExtensions, Iridescence) {
    GltfBuilder builder;
    const size_t both = add_texture(builder, {10, 20, 30});
    const Material m = read(builder, {{"KHR_materials_iridescence",
                                       {{"iridescenceFactor", 0.5},
                                        {"iridescenceTexture", {{"index", both}}},
                                        {"iridescenceIor", 1.75},
                                        {"iridescenceThicknessMinimum", 200.0},
                                        {"iridescenceThicknessMaximum", 500.0},
                                        {"iridescenceThicknessTexture", {{"index", both}}}}}});
    EXPECT_EQ(m.iridescence, 0.5f);
    EXPECT_EQ(m.iridescence_ior, 1.75f);
    EXPECT_EQ(m.iridescence_thickness_min, 200.0f);
    EXPECT_EQ(m.iridescence_thickness_max, 500.0f);
    EXPECT_EQ(value_at(m.iridescence_texture), 10);
    EXPECT_EQ(value_at(m.iridescence_thickness_texture), 20);
    expect_same_values(m, written(m));
    const Material defaults = read({{"KHR_materials_iridescence", Json::object()}});
    EXPECT_EQ(defaults.iridescence_ior, 1.3f);
    EXPECT_EQ(defaults.iridescence_thickness_max, 400.0f);
    EXPECT_FALSE(defaults.is_extended());
}

TEST(GltfExtensions, Anisotropy) {
    GltfBuilder builder;
    const size_t texture = add_texture(builder, {10, 20, 30});
    const Material m = read(builder, {{"KHR_materials_anisotropy",
                                       {{"anisotropyStrength", 0.5},
                                        {"anisotropyRotation", pi / 3},
                                        {"anisotropyTexture", {{"index", texture}}}}}});
    EXPECT_EQ(m.anisotropy, 0.5f);
    EXPECT_NEAR(m.anisotropy_rotation_deg, 60, 1e-5);
    EXPECT_TRUE(bool(m.anisotropy_texture));
    expect_same_values(m, written(m));
}

TEST(GltfExtensions, EmissiveStrengthMultiplies) {
    GltfBuilder builder;
    builder.triangle()["material"] = 0;
    builder.json["materials"] = {
        {{"emissiveFactor", {0.5, 1.0, 0.25}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8.0}}}}}}};
    const Material m = material_of(io::decode_gltf(as_span(builder.glb()), "test.glb"));
    EXPECT_EQ(m.emissive, Vec3(4, 8, 2));
    expect_same_values(m, written(m));
}

// A mesh made elsewhere keeps one-channel textures in any channel; the format fixes it.
TEST(GltfExtensions, WritingMovesChannels) {
    auto image = std::make_shared<Image>(2, 2, 1, PixelType::u8);
    for (uint8_t& v : image->pixels<uint8_t>()) v = 77;
    Material m;
    m.clearcoat = m.transmission = m.iridescence = m.thickness = 1;
    m.specular = 0.5f;
    m.sheen_color = Vec3(1, 1, 1);
    for (Texture Material::*use : {&Material::clearcoat_texture, &Material::clearcoat_roughness_texture,
                                   &Material::transmission_texture, &Material::iridescence_texture,
                                   &Material::iridescence_thickness_texture, &Material::thickness_texture,
                                   &Material::specular_texture, &Material::sheen_roughness_texture})
        (m.*use).image = image;
    expect_same_values(m, written(m));
}

TEST(GltfExtensions, ValuesOutOfRangeAreDrawnWithTheNearest) {
    const LogCapture log;
    const Material m = read({{"KHR_materials_clearcoat", {{"clearcoatFactor", 2.5}}},
                             {"KHR_materials_ior", {{"ior", 0.5}}},
                             {"KHR_materials_sheen", {{"sheenColorFactor", {-1.0, 0.5, 3.0}}}},
                             {"KHR_materials_volume", {{"attenuationDistance", 0}}},
                             {"KHR_materials_iridescence", {{"iridescenceIor", 0.2}}}});
    EXPECT_EQ(m.clearcoat, 1.0f);
    EXPECT_EQ(m.ior, 1.0f);
    EXPECT_EQ(m.sheen_color, Vec3(0, 0.5f, 1));
    EXPECT_GT(m.attenuation_distance, 0.0f);
    EXPECT_EQ(m.iridescence_ior, 1.0f);
    EXPECT_NE(log.text.find("test.glb, material 'm': clearcoat: expected 0 to 1, got 2.5; drawn with 1"),
              std::string::npos)
        << log.text;
    EXPECT_NE(log.text.find("ior: expected 0, or 1 and more, got 0.5"), std::string::npos) << log.text;
}

TEST(GltfExtensions, WrongTypesAreRefused) {
    EXPECT_THROW(read({{"KHR_materials_clearcoat", {{"clearcoatFactor", "much"}}}}), FormatError);
    EXPECT_THROW(read({{"KHR_materials_sheen", {{"sheenColorFactor", {1, 2}}}}}), FormatError);
    EXPECT_THROW(read({{"KHR_materials_transmission", {{"transmissionTexture", {{"index", 7}}}}}}),
                 FormatError);
}

}  // namespace

}  // namespace easypbr::gltf_extensions_test
