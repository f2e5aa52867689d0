#include "easypbr/core/color.h"
#include "easypbr/core/luminance.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/scene/settings.h"

namespace easypbr::render {
namespace {

struct NumberOverride {
    Override<float> MaterialSettings::*setting;
    float Material::*value;
    Texture Material::*texture;  ///< of the material's own, which would multiply it; may be null
};

constexpr NumberOverride number_overrides[] = {
    {&MaterialSettings::opacity, &Material::opacity, &Material::opacity_texture},
    {&MaterialSettings::clearcoat, &Material::clearcoat, &Material::clearcoat_texture},
    {&MaterialSettings::clearcoat_roughness, &Material::clearcoat_roughness,
     &Material::clearcoat_roughness_texture},
    {&MaterialSettings::sheen_roughness, &Material::sheen_roughness, &Material::sheen_roughness_texture},
    {&MaterialSettings::ior, &Material::ior, nullptr},
    {&MaterialSettings::specular, &Material::specular, &Material::specular_texture},
    {&MaterialSettings::transmission, &Material::transmission, &Material::transmission_texture},
    {&MaterialSettings::thickness, &Material::thickness, &Material::thickness_texture},
    {&MaterialSettings::attenuation_distance, &Material::attenuation_distance, nullptr},
    {&MaterialSettings::dispersion, &Material::dispersion, nullptr},
    {&MaterialSettings::iridescence, &Material::iridescence, &Material::iridescence_texture},
    {&MaterialSettings::iridescence_ior, &Material::iridescence_ior, nullptr},
    {&MaterialSettings::iridescence_thickness, &Material::iridescence_thickness_max,
     &Material::iridescence_thickness_texture},
    {&MaterialSettings::anisotropy, &Material::anisotropy, &Material::anisotropy_texture},
    {&MaterialSettings::anisotropy_rotation_deg, &Material::anisotropy_rotation_deg, nullptr}};

struct ColorOverride {
    Override<Vec3> MaterialSettings::*setting;
    Vec3 Material::*value;
    Texture Material::*texture;
};

constexpr ColorOverride color_overrides[] = {
    {&MaterialSettings::sheen_color, &Material::sheen_color, &Material::sheen_color_texture},
    {&MaterialSettings::specular_color, &Material::specular_color, &Material::specular_color_texture},
    {&MaterialSettings::attenuation_color, &Material::attenuation_color, nullptr}};

void override_extensions(Material& m, const MaterialSettings& settings) {
    for (const NumberOverride& o : number_overrides) {
        if (!(settings.*o.setting).value()) continue;
        m.*o.value = *(settings.*o.setting);
        if (o.texture) m.*o.texture = {};
    }
    for (const ColorOverride& o : color_overrides) {
        if (!(settings.*o.setting).value()) continue;
        m.*o.value = linear_from_srgb(*(settings.*o.setting));
        if (o.texture) m.*o.texture = {};
    }
    // An opacity from outside is meant to be seen.
    if (settings.opacity.value()) m.alpha_mode = automatic;
}

}  // namespace

Material overridden(const Material& material, const MaterialSettings& settings, const Material& textures) {
    Material m = material;
    // A value from outside stands for the whole: the material's own map would multiply it away.
    if (settings.color.value()) {
        m.base_color = linear_from_srgb(*settings.color), m.base_color_texture = {};
        m.base_color_given = true;
    }
    if (settings.metallic.value()) m.metallic = *settings.metallic, m.metallic_texture = {};
    if (settings.roughness.value()) m.roughness = *settings.roughness, m.roughness_texture = {};
    if (settings.emissive.value()) m.emissive = linear_from_srgb(*settings.emissive), m.emissive_texture = {};
    override_extensions(m, settings);
    // A texture from outside stands for the whole value unless a factor is given beside it.
    const auto replace = [](Texture& own, const Texture& given, auto&& neutral_factor) {
        if (!given) return;
        own = given;
        neutral_factor();
    };
    replace(m.base_color_texture, textures.base_color_texture, [&] {
        if (!settings.color.value()) m.base_color = Vec3::Ones();
    });
    replace(m.metallic_texture, textures.metallic_texture, [&] {
        if (!settings.metallic.value()) m.metallic = 1;
    });
    replace(m.roughness_texture, textures.roughness_texture, [&] {
        if (!settings.roughness.value()) m.roughness = 1;
    });
    replace(m.emissive_texture, textures.emissive_texture, [&] {
        if (is_black(m.emissive)) m.emissive = Vec3::Ones();
    });
    replace(m.normal_texture, textures.normal_texture, [] {});
    replace(m.occlusion_texture, textures.occlusion_texture, [] {});
    replace(m.opacity_texture, textures.opacity_texture, [&] {
        if (m.alpha_mode.value_or(AlphaMode::opaque) == AlphaMode::opaque) m.alpha_mode = AlphaMode::mask;
    });
    if (textures.shader) m.shader = textures.shader;
    // Said outright, it holds for textures from outside too.
    if (settings.alpha_mode.value()) m.alpha_mode = *settings.alpha_mode;
    return m;
}

}  // namespace easypbr::render
