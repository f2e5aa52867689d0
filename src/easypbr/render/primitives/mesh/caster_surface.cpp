#include "easypbr/render/primitives/mesh/caster_surface.h"

#include <algorithm>

#include "easypbr/render/primitives/mesh/mesh_material.h"

namespace easypbr::render {

bool casts_by_texture(const DrawItem& item) {
    const Material& m = item.material;
    const bool any =
        m.base_color_texture || m.opacity_texture || (item.casts_tint() && m.transmission_texture);
    return (item.alpha != AlphaMode::opaque || item.casts_tint()) && item.textured() && any;
}

std::vector<std::string> mesh_caster_defines(const DrawItem& item) {
    const Material& m = item.material;
    const bool with_uv = casts_by_texture(item), tints = item.casts_tint();
    std::vector<std::string> defines;
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.alpha == AlphaMode::opaque) defines.emplace_back("COVERS");
    if (tints) defines.emplace_back("TINT");
    if ((item.alpha != AlphaMode::opaque || tints) && item.with_colors) defines.emplace_back("VERTEX_COLOR");
    if (with_uv) defines.emplace_back("UV");
    if (with_uv && m.base_color_texture) defines.emplace_back("BASE_COLOR_TEXTURE");
    if (with_uv && m.opacity_texture) defines.emplace_back("OPACITY_TEXTURE");
    if (with_uv && tints && m.transmission_texture) defines.emplace_back("TRANSMISSION_TEXTURE");
    return defines;
}

float share_of_face(const DrawItem& item, gpu::Winding winding) {
    return item.is_volume() && winding != gpu::Winding::open ? 0.5f : 1.0f;
}

Vec3 light_through(const DrawItem& item, float share) {
    if (item.kind != SurfaceKind::lit) return Vec3::Zero();
    Material m = item.material;
    m.thickness *= float(item.scale());
    const Vec3 through = m.transmittance(AlphaMode::opaque);
    return share < 1 ? Vec3(through.cwiseSqrt()) : through;
}

ShaderInputs caster_inputs(const DrawItem& item, gpu::Winding winding, gpu::TextureCache& textures,
                           bool native) {
    const Material& m = item.material;
    const float share = share_of_face(item, winding);
    ShaderInputs values;
    values.define(mesh_caster_defines(item));
    values.set("u_opacity", m.opacity);
    values.set("u_alpha_cutoff", m.alpha_cutoff);
    values.set("u_through", light_through(item, share));
    values.set("u_root", share);
    if (!casts_by_texture(item)) return values;
    const auto set = [&](const Texture& texture, const std::string& name) {
        if (!texture) return;
        const bool is_color = &texture == &m.base_color_texture;
        const gpu::TexelKind kind = texel_kind(item, texture, is_color ? TexelUse::color : TexelUse::number);
        const std::string slot = name + "_texture";
        if (native)
            values.set("u_" + slot, textures.host(texture, kind, slot));
        else
            values.set("u_" + slot, textures.get(texture, kind, slot));
        values.set("u_" + name + "_uv", texture.uv_transform);
        if (!is_color)
            values.set("u_" + name + "_channel", Vec4(Vec4::Unit(std::clamp(texture.channel, 0, 3))));
    };
    set(m.base_color_texture, "base_color");
    set(m.opacity_texture, "opacity");
    if (item.casts_tint()) set(m.transmission_texture, "transmission");
    return values;
}

CasterSurface::CasterSurface(const ShadowView& view, int resolution, const DrawItem& item,
                             gpu::Winding winding, gpu::TextureCache& textures, const float* colors) {
    const MeshData& mesh = item.mesh();
    const Mat4d clip_from_mesh = view.clip_from_world() * item.object->T_world_mesh.matrix();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            triangles_.clip_from_mesh[row][column] = clip_from_mesh(row, column);
    triangles_.V = mesh.V.data();
    triangles_.F = mesh.F.data();
    triangles_.first_face = uint32_t(item.part.first_face);
    triangles_.pixel_width = triangles_.pixel_height = 2.0 / resolution;
    if (casts_by_texture(item)) triangles_.attributes.uvs = mesh.UV.data();
    triangles_.attributes.colors = colors;
    Transfers none;
    shader_ = native::caster_uniforms(caster_inputs(item, winding, textures, true).native(none));
    triangles_.shader = shader_.get();
}

void CasterSurface::shade(std::span<const native::VisiblePixel> texels, std::span<float> values) const {
    native::casters_of_triangles(triangles_, texels, values);
}

void CasterSurface::alpha(std::span<const native::VisiblePixel> texels, std::span<float> alpha) const {
    std::vector<float> values(4 * texels.size());
    shade(texels, values);
    for (size_t i = 0; i < texels.size(); ++i) alpha[i] = values[4 * i + 3];
}

}  // namespace easypbr::render
