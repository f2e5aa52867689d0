#include "easypbr/render/primitives/mesh/mesh_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "easypbr/core/ascii.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// A texture of the shader; its place in the table is its row of u_uv_transform.
struct TextureUse {
    explicit TextureUse(const MaterialTexture& row_)
        : row(row_),
          slot(fmt::format("{}_texture", row.name)),
          sampler("u_" + slot),
          define(ascii::to_upper(slot)) {
        if (row.use == TexelUse::number) channel = fmt::format("u_{}_channel", row.name);
    }

    const MaterialTexture& row;
    std::string slot;  ///< the material's name for it
    std::string sampler, define;
    std::string channel;  ///< uniform that picks one channel; empty where all are read
};

const std::vector<TextureUse>& texture_uses() {
    static const std::vector<TextureUse> uses(material_textures().begin(), material_textures().end());
    return uses;
}

/// How many rows of u_uv_transform the shader has: those of the core model stand first.
size_t texture_count(bool extended) {
    return extended ? material_textures().size() : replaceable_textures().size();
}

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
    const size_t count = texture_count(is_extended(context, item));
    for (size_t i = 0; i < count; ++i) {
        const TextureUse& use = texture_uses()[i];
        const Texture Material::*texture = use.row.texture;
        const bool is_unread = texture == &Material::occlusion_texture && !context.occlusion;
        if ((item.material.*texture) && !is_unread) visit(use, i);
    }
}

Vec4 with_w(const Vec3& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

void set_extensions(ShaderInputs& values, const ResolvedSettings& resolved, const DrawItem& item) {
    const Material& m = item.material;
    values.set("u_coat", Vec3(m.clearcoat, m.clearcoat_roughness, m.clearcoat_normal_scale));
    values.set("u_sheen", with_w(m.sheen_color, m.sheen_roughness));
    const float f0 = m.dielectric_f0(resolved.settings.shading.dielectric_f0);
    values.set("u_specular", with_w(m.specular_color * f0, m.specular));
    values.set("u_film", Vec4(m.iridescence, m.iridescence_ior, m.iridescence_thickness_min,
                              m.iridescence_thickness_max));
    const double angle = radians(double(m.anisotropy_rotation_deg));
    values.set("u_anisotropy", Vec3(m.anisotropy, float(std::cos(angle)), float(std::sin(angle))));
    const float thickness = m.thickness * float(item.scale());
    // What reflects all does not refract.
    values.set("u_volume", Vec4(m.transmission, thickness, m.ior > 0 ? m.ior : 1.0f, m.dispersion));
    values.set("u_absorption", absorption_of(m));
    values.set("u_up", Vec3(parse_up(resolved.settings.camera.up).cast<float>()));
}

}  // namespace

gpu::TexelKind texel_kind(const DrawItem& item, const Texture& texture, TexelUse use) {
    if (use != TexelUse::color) return gpu::TexelKind::data;
    const bool covers = &texture == &item.material.base_color_texture && item.alpha != AlphaMode::opaque;
    return covers ? gpu::TexelKind::covering_color : gpu::TexelKind::color;
}

void add_mesh_defines(const DrawItem& item, bool normals_agree, std::vector<std::string>& defines) {
    if (item.with_colors) defines.emplace_back("VERTEX_COLOR");
    if (item.style.flat || (item.two_sided && !normals_agree)) defines.emplace_back("FACE_NORMAL");
    if (item.style.flat) defines.emplace_back("FLAT");
    if (item.two_sided) defines.emplace_back("TWO_SIDED");
}

void add_material_defines(const MaterialContext& context, const DrawItem& item,
                          std::vector<std::string>& defines) {
    if (item.textured() || (item.material.shader && !item.mesh().UV.empty())) defines.emplace_back("UV");
    if (item.needs_tangents()) defines.emplace_back("TANGENT");
    const bool extended = is_extended(context, item);
    if (extended) defines.emplace_back("EXTENDED");
    defines.push_back(fmt::format("UV_TRANSFORMS {}", texture_count(extended)));
    for_each_texture(context, item, [&](const TextureUse& use, size_t) { defines.emplace_back(use.define); });
    const Material& m = item.material;
    if (item.textured() && m.metallic_texture && m.roughness_texture &&
        same_texels(m.metallic_texture, m.roughness_texture))
        defines.emplace_back("ROUGHNESS_IN_METALLIC");
}

ShaderInputs material_inputs(const MaterialContext& context, const DrawItem& item,
                             gpu::TextureCache& textures, bool native) {
    const Material& m = item.material;
    const SurfaceKind kind = m.unlit                      ? SurfaceKind::unlit
                             : is_extended(context, item) ? SurfaceKind::extended
                                                          : item.kind;
    ShaderInputs values;
    values.set("u_base_color", with_w(m.base_color, m.opacity));
    values.set("u_surface", Vec4(m.metallic, m.roughness, m.occlusion_strength, m.alpha_cutoff));
    values.set("u_emissive", with_w(m.emissive, code_of(kind)));
    values.set("u_normal_scale", m.normal_scale);
    // Jittered frames see finer detail together than one alone: a level less of blur from four samples on.
    values.set("u_lod_bias", context.sample_count >= 4 ? -1.0f : 0.0f);
    // The mean of what a mask leaves of jittered samples is its coverage; a blurred one leaves all or
    // nothing.
    const bool averages_mask = item.alpha == AlphaMode::mask && context.sample_count > 1;
    values.set("u_exact_mask", averages_mask ? 1.0f : 0.0f);
    if (is_extended(context, item)) set_extensions(values, *context.resolved, item);
    for_each_texture(context, item, [&](const TextureUse& use, size_t index) {
        const Texture& texture = m.*use.row.texture;
        const gpu::TexelKind kind = texel_kind(item, texture, use.row.use);
        if (native)
            values.set(use.sampler, textures.host(texture, kind, use.slot));
        else
            values.set(use.sampler, textures.get(texture, kind, use.slot));
        if (!use.channel.empty()) values.set(use.channel, channel_mask(texture.channel));
        values.set("u_uv_transform[" + std::to_string(index) + "]", texture.uv_transform);
    });
    return values;
}

}  // namespace easypbr::render
