#include "easypbr/scene/material_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/luminance.h"
#include "easypbr/scene/settings.h"

namespace easypbr {
namespace {

constexpr float largest_number = 3e38f;
constexpr float infinite = std::numeric_limits<float>::infinity();
/// Below any length that occurs, above zero.
constexpr float smallest_length = 1e-30f;

constexpr MaterialNumber numbers[] = {
    {"opacity", &Material::opacity, 0, 1, "0 transparent to 1 opaque."},
    {"metallic", &Material::metallic, 0, 1, "0 dielectric to 1 metal."},
    {"roughness", &Material::roughness, 0, 1, "Perceptual roughness, 0 to 1; alpha = roughness^2."},
    {"normal_scale", &Material::normal_scale, -largest_number, largest_number,
     "Scale of the normal texture."},
    {"occlusion_strength", &Material::occlusion_strength, 0, 1, "Strength of the occlusion texture."},
    {"alpha_cutoff", &Material::alpha_cutoff, 0, largest_number,
     "Alpha mode mask: fragments below this alpha are discarded."},
    {"clearcoat", &Material::clearcoat, 0, 1, "Clearcoat strength, 0 to 1."},
    {"clearcoat_roughness", &Material::clearcoat_roughness, 0, 1, "Clearcoat roughness, 0 to 1."},
    {"clearcoat_normal_scale", &Material::clearcoat_normal_scale, -largest_number, largest_number,
     "Scale of the clearcoat normal texture."},
    {"sheen_roughness", &Material::sheen_roughness, 0, 1, "Sheen roughness, 0 to 1."},
    {"ior", &Material::ior, 0, 100, "Index of refraction of a dielectric, at least 1; 0: reflectance 1."},
    {"specular", &Material::specular, 0, 1, "Strength of the specular reflection of dielectrics, 0 to 1."},
    {"transmission", &Material::transmission, 0, 1,
     "Transmission, the fraction of light transmitted by dielectrics, 0 to 1."},
    {"thickness", &Material::thickness, 0, largest_number,
     "Thickness of the volume below the surface in mesh units; 0: thin-walled."},
    {"attenuation_distance", &Material::attenuation_distance, smallest_length, infinite,
     "Distance in the volume after which white light has the attenuation colour, in world units."},
    {"dispersion", &Material::dispersion, 0, 40,
     "Dispersion of the volume below the surface, 20 / Abbe number: glass 0.3 to 0.8."},
    {"iridescence", &Material::iridescence, 0, 1, "Iridescence strength, 0 to 1."},
    {"iridescence_ior", &Material::iridescence_ior, 1, 100, "Index of refraction of the thin film."},
    {"iridescence_thickness_min", &Material::iridescence_thickness_min, 0, largest_number,
     "Thickness of the thin film in nanometres where its texture is 0."},
    {"iridescence_thickness_max", &Material::iridescence_thickness_max, 0, largest_number,
     "Thickness of the thin film in nanometres where its texture is 1 or absent."},
    {"anisotropy", &Material::anisotropy, 0, 1, "Anisotropy strength, 0 to 1."},
    {"anisotropy_rotation_deg", &Material::anisotropy_rotation_deg, -largest_number, largest_number,
     "Rotation of the anisotropy in degrees, counter-clockwise from the tangent."}};

constexpr MaterialColor colors[] = {
    {"base_color", &Material::base_color, largest_number, "Linear base colour."},
    {"emissive", &Material::emissive, largest_number, "Linear emitted radiance."},
    {"sheen_color", &Material::sheen_color, 1, "Linear sheen colour; black: no sheen."},
    {"specular_color", &Material::specular_color, largest_number,
     "Linear specular colour of dielectrics at normal incidence."},
    {"attenuation_color", &Material::attenuation_color, 1,
     "Linear colour of white light after the attenuation distance."}};

constexpr MaterialTexture textures[] = {
    {"base_color", &Material::base_color_texture, TexelUse::color,
     "Of faces; times the base colour unless that is the default. Its alpha multiplies opacity.",
     &MaterialSettings::base_color_texture, "Base colour texture file (sRGB) of every material."},
    {"metallic", &Material::metallic_texture, TexelUse::number, "Its first channel is read.",
     &MaterialSettings::metallic_texture, "Metallic texture file of every material."},
    {"roughness", &Material::roughness_texture, TexelUse::number, "Its first channel is read.",
     &MaterialSettings::roughness_texture, "Roughness texture file of every material."},
    {"occlusion", &Material::occlusion_texture, TexelUse::number, "Its first channel is read.",
     &MaterialSettings::occlusion_texture, "Baked ambient occlusion texture file of every material."},
    {"normal", &Material::normal_texture, TexelUse::vector, "Tangent space, +Y up.",
     &MaterialSettings::normal_texture, "Normal map file of every material, tangent space, +Y up (OpenGL)."},
    {"emissive", &Material::emissive_texture, TexelUse::color, "Emitted radiance.",
     &MaterialSettings::emissive_texture, "Emissive texture file (sRGB) of every material."},
    {"opacity", &Material::opacity_texture, TexelUse::number, "Used by alpha modes mask and blend.",
     &MaterialSettings::opacity_texture, "Opacity texture file of every material."},
    {"clearcoat", &Material::clearcoat_texture, TexelUse::number, "Its first channel is read."},
    {"clearcoat_roughness", &Material::clearcoat_roughness_texture, TexelUse::number,
     "Its first channel is read."},
    {"clearcoat_normal", &Material::clearcoat_normal_texture, TexelUse::vector,
     "Normals of the clearcoat, tangent space, +Y up."},
    {"sheen_color", &Material::sheen_color_texture, TexelUse::color, "Sheen colour."},
    {"sheen_roughness", &Material::sheen_roughness_texture, TexelUse::number, "Its first channel is read."},
    {"specular", &Material::specular_texture, TexelUse::number, "Its first channel is read."},
    {"specular_color", &Material::specular_color_texture, TexelUse::color, "Specular colour."},
    {"transmission", &Material::transmission_texture, TexelUse::number, "Its first channel is read."},
    {"thickness", &Material::thickness_texture, TexelUse::number, "Its first channel is read."},
    {"iridescence", &Material::iridescence_texture, TexelUse::number, "Its first channel is read."},
    {"iridescence_thickness", &Material::iridescence_thickness_texture, TexelUse::number,
     "Interpolates from the minimum to the maximum thickness; its first channel is read."},
    {"anisotropy", &Material::anisotropy_texture, TexelUse::vector,
     "Red and green: direction in tangent space; blue: strength."}};

std::string range_text(float min, float max) {
    if (max >= largest_number && min <= -largest_number) return "a finite number";
    if (max >= largest_number) return min > 0 ? "more than 0" : fmt::format("at least {}", min);
    return fmt::format("{} to {}", min, max);
}

/// At normal incidence from air; everything where the index is 0.
float reflectance(float ior) {
    return ior > 0 ? std::pow((ior - 1) / (ior + 1), 2.0f) : 1.0f;
}

/// Calls problem(name, expected, given, fix) for every value outside of its range.
template <class M, class Problem>
void for_each_problem(M& material, Problem&& problem) {
    for (const MaterialNumber& number : numbers) {
        auto& value = material.*number.value;
        if (value >= number.min && value <= number.max) continue;
        const float nearest =
            std::isnan(value) ? Material().*number.value : std::clamp(value, number.min, number.max);
        problem(number.name, range_text(number.min, number.max), fmt::format("{}", value), value, nearest);
    }
    for (const MaterialColor& color : colors)
        for (int c = 0; c < 3; ++c) {
            auto& value = (material.*color.value)[c];
            if (value >= 0 && value <= color.max) continue;
            const float nearest =
                std::isnan(value) ? (Material().*color.value)[c] : std::clamp<float>(value, 0, color.max);
            const Vec3 given = material.*color.value;
            problem(color.name, range_text(0, color.max),
                    fmt::format("({}, {}, {})", given.x(), given.y(), given.z()), value, nearest);
        }
    // Between no refraction at all and the special value 0 nothing is meant.
    if (material.ior > 0 && material.ior < 1)
        problem("ior", "0, or 1 and more", fmt::format("{}", material.ior), material.ior, 1.0f);
}

}  // namespace

std::span<const MaterialNumber> material_numbers() {
    return numbers;
}

std::span<const MaterialColor> material_colors() {
    return colors;
}

std::span<const MaterialTexture> material_textures() {
    return textures;
}

std::span<const MaterialTexture> replaceable_textures() {
    constexpr auto has_none = [](const MaterialTexture& row) { return !row.setting; };
    static const auto end = std::ranges::find_if(textures, has_none);
    return {std::begin(textures), end};
}

void validate(const Material& material) {
    const auto refuse = [&](const std::string& name, const std::string& expected, const std::string& given) {
        throw ArgumentError(fmt::format("material{}.{}: expected {}, got {}",
                                        material.name.empty() ? "" : fmt::format(" '{}'", material.name),
                                        name, expected, given));
    };
    for_each_problem(material, [&](const char* name, const std::string& expected, const std::string& given,
                                   const float&, float) { refuse(name, expected, given); });
    for (const MaterialTexture& row : textures)
        if (const auto& image = (material.*row.texture).image; image && image->empty())
            refuse(fmt::format("{}_texture", row.name), "an image with pixels, or none", "an empty one");
}

std::vector<std::string> clamp_to_ranges(Material& material) {
    std::vector<std::string> changes;
    for_each_problem(material, [&](const char* name, const std::string& expected, const std::string& given,
                                   float& value, float nearest) {
        changes.push_back(
            fmt::format("{}: expected {}, got {}; drawn with {}", name, expected, given, nearest));
        value = nearest;
    });
    return changes;
}

bool Material::has_textures() const {
    return std::ranges::any_of(textures, [&](const MaterialTexture& t) { return bool(this->*t.texture); });
}

bool Material::has_default_color() const {
    return !base_color_given && base_color == Material().base_color;
}

Vec3 Material::color_factor(bool with_colors, bool with_coordinates) const {
    const bool is_beside = with_colors || (with_coordinates && base_color_texture);
    return is_beside && has_default_color() ? Vec3(Vec3::Ones()) : base_color;
}

bool Material::is_extended() const {
    return clearcoat > 0 || !is_black(sheen_color) || names_ior() || specular != 1 ||
           specular_color != Vec3::Ones() || transmission > 0 || iridescence > 0 || anisotropy > 0 ||
           specular_texture || specular_color_texture;
}

AlphaMode Material::alpha_mode_for(bool transparent_vertices) const {
    if (alpha_mode.value()) return *alpha_mode;
    if (opacity < 1 || transparent_vertices) return AlphaMode::blend;
    return opacity_texture ? AlphaMode::mask : AlphaMode::opaque;
}

float Material::dielectric_f0(float unnamed) const {
    return names_ior() ? reflectance(ior) : unnamed;
}

float Material::ior_of_channel(int channel) const {
    const float center = ior > 0 ? ior : 1.0f;
    return center + float(channel - 1) * 0.025f * dispersion * (center - 1);
}

Vec3 Material::transmittance(AlphaMode mode) const {
    const float coverage = mode == AlphaMode::blend ? opacity : 1;
    Vec3 through = base_color.cwiseMin(1.0f) * (transmission * (1 - metallic) * (1 - reflectance(ior)));
    if (thickness > 0 && std::isfinite(attenuation_distance))
        through.array() *= attenuation_color.array().pow(thickness / attenuation_distance);
    return Vec3::Constant(1 - coverage) + coverage * through;
}

bool has_transparent_colors(const ArrayXf& C) {
    if (C.cols() != 4 || C.empty()) return false;
    const auto alpha = C.col(3);
    return alpha.minCoeff() < 1 && alpha.maxCoeff() > 0;
}

}  // namespace easypbr
