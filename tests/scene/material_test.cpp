#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/settings.h"

namespace easypbr::material_test {

namespace {

std::string message_of(const Material& material) {
    try {
        validate(material);
    } catch (const ArgumentError& error) {
        return error.what();
    }
    return "accepted";
}

ArrayXf colors(std::initializer_list<float> alphas) {
    ArrayXf::Dense C(Eigen::Index(alphas.size()), 4);
    C.setOnes();
    Eigen::Index row = 0;
    for (const float alpha : alphas) C(row++, 3) = alpha;
    return C;
}

}  // namespace

TEST(Material, DefaultsAreInRange) {
    EXPECT_EQ(message_of(Material()), "accepted");
}

TEST(Material, EveryNumberAndColorIsChecked) {
    for (const MaterialNumber& number : material_numbers()) {
        for (const float bad : {std::nanf(""), -std::numeric_limits<float>::infinity()}) {
            Material m;
            m.*number.value = bad;
            EXPECT_NE(message_of(m).find(number.name), std::string::npos) << number.name << " " << bad;
            Material clamped = m;
            EXPECT_EQ(clamp_to_ranges(clamped).size(), 1u) << number.name;
            EXPECT_EQ(message_of(clamped), "accepted") << number.name;
        }
    }
    for (const MaterialColor& color : material_colors())
        for (int c = 0; c < 3; ++c)
            for (const float bad : {std::nanf(""), -0.5f, std::numeric_limits<float>::infinity()}) {
                Material m;
                (m.*color.value)[c] = bad;
                EXPECT_NE(message_of(m).find(color.name), std::string::npos) << color.name << " " << bad;
                clamp_to_ranges(m);
                EXPECT_EQ(message_of(m), "accepted") << color.name;
            }
}

TEST(Material, MessagesSayWhatIsExpected) {
    Material m;
    m.name = "paint";
    m.clearcoat = 1.5f;
    EXPECT_EQ(message_of(m), "material 'paint'.clearcoat: expected 0 to 1, got 1.5");
    m = {};
    m.ior = 0.7f;
    EXPECT_EQ(message_of(m), "material.ior: expected 0, or 1 and more, got 0.7");
    Mesh mesh;
    EXPECT_THROW(mesh.set_material(m), ArgumentError);
}

TEST(Material, AutomaticAlphaMode) {
    Material m;
    EXPECT_EQ(m.alpha_mode_for(false), AlphaMode::opaque);
    EXPECT_EQ(m.alpha_mode_for(true), AlphaMode::blend);
    m.opacity_texture.image = std::make_shared<Image>(1, 1, 1, PixelType::u8);
    EXPECT_EQ(m.alpha_mode_for(false), AlphaMode::mask);
    m.opacity = 0.5f;
    EXPECT_EQ(m.alpha_mode_for(false), AlphaMode::blend);
    m.alpha_mode = AlphaMode::opaque;
    EXPECT_EQ(m.alpha_mode_for(true), AlphaMode::opaque);
}

TEST(Material, TransparentColors) {
    EXPECT_FALSE(has_transparent_colors({}));
    EXPECT_FALSE(has_transparent_colors(colors({1, 1})));
    EXPECT_TRUE(has_transparent_colors(colors({1, 0.5f})));
    EXPECT_TRUE(has_transparent_colors(colors({1, 0})));
    // Some programs write alpha 0 everywhere and mean nothing by it.
    EXPECT_FALSE(has_transparent_colors(colors({0, 0, 0})));
    EXPECT_FALSE(has_transparent_colors(ArrayXf::Dense(ArrayXf::Dense::Zero(3, 3))));
}

TEST(Material, TransmittanceForShadows) {
    Material m;
    EXPECT_EQ(m.transmittance(AlphaMode::opaque), Vec3(0, 0, 0));
    m.opacity = 0.25f;
    EXPECT_EQ(m.transmittance(AlphaMode::blend), Vec3(0.75f, 0.75f, 0.75f));
    EXPECT_EQ(m.transmittance(AlphaMode::opaque), Vec3(0, 0, 0));
    m.opacity = 1;
    m.transmission = 1;
    m.base_color = Vec3(1, 0.5f, 0);
    // The rest is reflected: F0 = 0.04.
    EXPECT_TRUE(m.transmittance(AlphaMode::opaque).isApprox(Vec3(0.96f, 0.48f, 0), 1e-6f));
    m.thickness = 2;
    m.attenuation_distance = 1;
    m.attenuation_color = Vec3(0.5f, 1, 1);
    EXPECT_TRUE(m.transmittance(AlphaMode::opaque).isApprox(Vec3(0.24f, 0.48f, 0), 1e-6f));
}

TEST(Material, EveryTextureStandsInTheTableOnce) {
    std::set<std::string> names;
    Material m;
    EXPECT_FALSE(m.has_textures());
    for (const MaterialTexture& use : material_textures()) {
        EXPECT_TRUE(names.insert(use.name).second);
        (m.*use.texture).image = std::make_shared<Image>(1, 1, 1, PixelType::u8);
        EXPECT_TRUE(m.has_textures());
        (m.*use.texture).image = nullptr;
    }
    EXPECT_EQ(names.size(), 19u);
}

TEST(Material, ReflectanceOfItsDielectricPart) {
    Material m;
    EXPECT_FALSE(m.names_ior());
    EXPECT_EQ(m.dielectric_f0(0.07f), 0.07f) << "names no index: what the settings say";
    m.ior = 1.33f;
    EXPECT_TRUE(m.names_ior());
    // ((1.33 - 1) / (1.33 + 1))^2
    EXPECT_NEAR(m.dielectric_f0(0.07f), 0.0200593f, 1e-6f);
    m.ior = 0;
    EXPECT_EQ(m.dielectric_f0(0.07f), 1);
}

// Its setting is the one that is named after it, and no other.
TEST(Material, ReplaceableTexturesHaveTheirSetting) {
    ASSERT_EQ(replaceable_textures().size(), 7u) << "of glTF's core model, with metallic and roughness apart";
    for (const MaterialTexture& row : material_textures()) {
        const std::string name = fmt::format("material.{}_texture", row.name);
        if (!row.setting) {
            EXPECT_THROW(field(name), NameError) << name;
            continue;
        }
        Settings settings;
        settings.material.*row.setting = "file.png";
        for (const Field& other : fields())
            EXPECT_EQ(other.get(settings) == other.get(Settings()), other.name != name)
                << name << ", " << other.name;
    }
}

}  // namespace easypbr::material_test
