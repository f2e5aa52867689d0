#include "easypbr/render/primitives/mesh/mesh_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace easypbr::render {
namespace {

/// A texture of the shader; its place in the table is its row of u_uv_transform.
struct TextureUse {
    const char* define;
    const char* sampler;
    const char* channel;  ///< uniform that picks one channel, or null
    Texture Material::*member;
    bool color;
};

/// The first seven belong to glTF's core model, the others to its extensions.
constexpr TextureUse texture_uses[] = {
    {"BASE_COLOR_TEXTURE", "u_base_color_texture", nullptr, &Material::base_color_texture, true},
    {"METALLIC_TEXTURE", "u_metallic_texture", "u_metallic_channel", &Material::metallic_texture, false},
    {"ROUGHNESS_TEXTURE", "u_roughness_texture", "u_roughness_channel", &Material::roughness_texture, false},
    {"OCCLUSION_TEXTURE", "u_occlusion_texture", "u_occlusion_channel", &Material::occlusion_texture, false},
    {"NORMAL_TEXTURE", "u_normal_texture", nullptr, &Material::normal_texture, false},
    {"EMISSIVE_TEXTURE", "u_emissive_texture", nullptr, &Material::emissive_texture, true},
    {"OPACITY_TEXTURE", "u_opacity_texture", "u_opacity_channel", &Material::opacity_texture, false},
    {"CLEARCOAT_TEXTURE", "u_clearcoat_texture", "u_clearcoat_channel", &Material::clearcoat_texture, false},
    {"CLEARCOAT_ROUGHNESS_TEXTURE", "u_clearcoat_roughness_texture", "u_clearcoat_roughness_channel",
     &Material::clearcoat_roughness_texture, false},
    {"CLEARCOAT_NORMAL_TEXTURE", "u_clearcoat_normal_texture", nullptr, &Material::clearcoat_normal_texture,
     false},
    {"SHEEN_COLOR_TEXTURE", "u_sheen_color_texture", nullptr, &Material::sheen_color_texture, true},
    {"SHEEN_ROUGHNESS_TEXTURE", "u_sheen_roughness_texture", "u_sheen_roughness_channel",
     &Material::sheen_roughness_texture, false},
    {"SPECULAR_TEXTURE", "u_specular_texture", "u_specular_channel", &Material::specular_texture, false},
    {"SPECULAR_COLOR_TEXTURE", "u_specular_color_texture", nullptr, &Material::specular_color_texture, true},
    {"TRANSMISSION_TEXTURE", "u_transmission_texture", "u_transmission_channel",
     &Material::transmission_texture, false},
    {"THICKNESS_TEXTURE", "u_thickness_texture", "u_thickness_channel", &Material::thickness_texture, false},
    {"IRIDESCENCE_TEXTURE", "u_iridescence_texture", "u_iridescence_channel", &Material::iridescence_texture,
     false},
    {"IRIDESCENCE_THICKNESS_TEXTURE", "u_iridescence_thickness_texture", "u_iridescence_thickness_channel",
     &Material::iridescence_thickness_texture, false},
    {"ANISOTROPY_TEXTURE", "u_anisotropy_texture", nullptr, &Material::anisotropy_texture, false}};

constexpr size_t core_texture_count = 7;

bool same_texels(const Texture& a, const Texture& b) {
    return a.image == b.image && a.uv_transform == b.uv_transform && a.wrap_u == b.wrap_u &&
           a.wrap_v == b.wrap_v && a.filter == b.filter;
}

Vec4 channel_mask(int channel) {
    Vec4 mask = Vec4::Zero();
    mask[std::clamp(channel, 0, 3)] = 1;
    return mask;
}

bool is_extended(const MaterialContext& context, const DrawItem& item) {
    return context.extensions && item.extensions();
}

/// Calls visit(use, index) for each texture that the item is drawn with.
template <class Visit>
void for_each_texture(const MaterialContext& context, const DrawItem& item, Visit&& visit) {
    if (!item.textured()) return;
    const size_t count = is_extended(context, item) ? std::size(texture_uses) : core_texture_count;
    for (size_t i = 0; i < count; ++i) {
        const TextureUse& use = texture_uses[i];
        const bool of_normals =
            use.member == &Material::normal_texture || use.member == &Material::clearcoat_normal_texture;
        if ((item.material.*use.member) && !(of_normals && item.style.flat)) visit(use, i);
    }
}

Vec4 with_w(const Vec3& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

/// What one thickness leaves of light, as logarithms.
Vec3 log_transmittance(const Material& m, float thickness) {
    if (!(thickness > 0) || !std::isfinite(m.attenuation_distance)) return Vec3::Zero();
    // e^-80 is nothing, and a number.
    const Vec3 per_distance = m.attenuation_color.cwiseMax(1e-30f).array().log();
    return (per_distance * (thickness / m.attenuation_distance)).cwiseMax(-80.0f);
}

void set_extension_uniforms(const gl::Program& program, const ResolvedSettings& resolved,
                            const DrawItem& item) {
    const Material& m = item.material;
    program.set("u_coat", Vec3(m.clearcoat, m.clearcoat_roughness, m.clearcoat_normal_scale));
    program.set("u_sheen", with_w(m.sheen_color, m.sheen_roughness));
    // A material that says nothing of its index has the settings' reflectance.
    const float f0 = m.ior == 1.5f ? resolved.settings.shading.dielectric_f0
                     : m.ior > 0   ? std::pow((m.ior - 1) / (m.ior + 1), 2.0f)
                                   : 1.0f;
    program.set("u_specular", with_w(m.specular_color * f0, m.specular));
    program.set("u_film", Vec4(m.iridescence, m.iridescence_ior, m.iridescence_thickness_min,
                               m.iridescence_thickness_max));
    const double angle = radians(double(m.anisotropy_rotation_deg));
    program.set("u_anisotropy", Vec3(m.anisotropy, float(std::cos(angle)), float(std::sin(angle))));
    const double scale = std::cbrt(std::abs(item.object->T_world_mesh.linear().determinant()));
    const float thickness = m.thickness * float(scale);
    // What reflects all does not refract.
    program.set("u_volume", Vec3(m.transmission, thickness, m.ior > 0 ? m.ior : 1.0f));
    program.set("u_attenuation", log_transmittance(m, thickness));
    program.set("u_up", Vec3(parse_up(resolved.settings.camera.up).cast<float>()));
}

}  // namespace

void add_material_defines(const MaterialContext& context, const DrawItem& item,
                          std::vector<std::string>& defines) {
    if (item.textured() || (item.material.shader && !item.mesh().UV.empty())) defines.emplace_back("UV");
    if (item.needs_tangents()) defines.emplace_back("TANGENT");
    const bool extended = is_extended(context, item);
    if (extended) defines.emplace_back("EXTENDED");
    defines.push_back(
        fmt::format("UV_TRANSFORMS {}", extended ? std::size(texture_uses) : core_texture_count));
    for_each_texture(context, item, [&](const TextureUse& use, size_t) { defines.emplace_back(use.define); });
    const Material& m = item.material;
    if (item.textured() && m.metallic_texture && m.roughness_texture &&
        same_texels(m.metallic_texture, m.roughness_texture))
        defines.emplace_back("ROUGHNESS_IN_METALLIC");
}

unsigned set_material(const gl::Program& program, const MaterialContext& context, const DrawItem& item,
                      gpu::TextureCache& textures) {
    const Material& m = item.material;
    const SurfaceKind kind = m.unlit                      ? SurfaceKind::unlit
                             : is_extended(context, item) ? SurfaceKind::extended
                                                          : item.kind;
    program.set("u_base_color", with_w(m.base_color, m.opacity));
    program.set("u_surface", Vec4(m.metallic, m.roughness, m.occlusion_strength, m.alpha_cutoff));
    program.set("u_emissive", with_w(m.emissive, code_of(kind)));
    program.set("u_normal_scale", m.normal_scale);
    // Jittered frames see finer detail together than one alone: a level less of blur from four samples on.
    program.set("u_lod_bias", context.sample_count >= 4 ? -1.0f : 0.0f);
    if (is_extended(context, item)) set_extension_uniforms(program, *context.resolved, item);
    unsigned unit = 0;
    for_each_texture(context, item, [&](const TextureUse& use, size_t index) {
        const Texture& texture = m.*use.member;
        textures.get(texture, use.color).bind(unit);
        program.set(use.sampler, int(unit++));
        if (use.channel) program.set(use.channel, channel_mask(texture.channel));
        program.set("u_uv_transform[" + std::to_string(index) + "]", texture.uv_transform);
    });
    return unit;
}

}  // namespace easypbr::render
