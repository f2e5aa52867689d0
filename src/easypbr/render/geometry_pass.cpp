#include "easypbr/render/geometry_pass.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace easypbr::render {
namespace {

/// Texture units and rows of u_uv_transform.
enum Slot {
    base_color_slot,
    metallic_slot,
    roughness_slot,
    occlusion_slot,
    normal_slot,
    emissive_slot,
    opacity_slot
};

constexpr unsigned peel_unit = 15;

struct TextureUse {
    Slot slot;
    const char* define;
    const char* sampler;
    const char* channel;  ///< uniform that picks one channel, or null
    Texture Material::*member;
    bool color;
};

constexpr TextureUse texture_uses[] = {
    {base_color_slot, "BASE_COLOR_TEXTURE", "u_base_color_texture", nullptr, &Material::base_color_texture,
     true},
    {metallic_slot, "METALLIC_TEXTURE", "u_metallic_texture", "u_metallic_channel",
     &Material::metallic_texture, false},
    {roughness_slot, "ROUGHNESS_TEXTURE", "u_roughness_texture", "u_roughness_channel",
     &Material::roughness_texture, false},
    {occlusion_slot, "OCCLUSION_TEXTURE", "u_occlusion_texture", "u_occlusion_channel",
     &Material::occlusion_texture, false},
    {normal_slot, "NORMAL_TEXTURE", "u_normal_texture", nullptr, &Material::normal_texture, false},
    {emissive_slot, "EMISSIVE_TEXTURE", "u_emissive_texture", nullptr, &Material::emissive_texture, true},
    {opacity_slot, "OPACITY_TEXTURE", "u_opacity_texture", "u_opacity_channel", &Material::opacity_texture,
     false}};

bool same_texels(const Texture& a, const Texture& b) {
    return a.image == b.image && a.uv_transform == b.uv_transform && a.wrap_u == b.wrap_u &&
           a.wrap_v == b.wrap_v && a.filter == b.filter;
}

Vec4 channel_mask(int channel) {
    Vec4 mask = Vec4::Zero();
    mask[std::clamp(channel, 0, 3)] = 1;
    return mask;
}

void set_culling(bool cull, bool mirrored) {
    if (cull) {
        glEnable(GL_CULL_FACE);
        glCullFace(GL_BACK);
    } else {
        glDisable(GL_CULL_FACE);
    }
    glFrontFace(mirrored ? GL_CW : GL_CCW);
}

}  // namespace

void GeometryPass::draw(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets) {
    const bool emission = frame.with_ids || frame.peel || std::ranges::any_of(items, &DrawItem::emits);
    const gl::Framebuffer& framebuffer = frame.with_ids ? targets.surface_ids
                                         : emission     ? targets.surface_emission
                                                        : targets.surface;
    framebuffer.bind();
    if (!frame.peel) targets.clear(frame.with_ids);
    test_geometry_depth(frame);
    for (size_t first = 0, last; first < items.size(); first = last) {
        // All parts of an object share its buffers.
        const auto same_object = [&](const DrawItem& item) { return item.object == items[first].object; };
        for (last = first; last < items.size() && same_object(items[last]);) ++last;
        const bool tangents = std::any_of(items.begin() + long(first), items.begin() + long(last),
                                          [](const DrawItem& item) { return item.normal_mapped(); });
        const gpu::MeshBuffers& buffers = meshes_.get(items[first].mesh(), tangents);
        for (size_t i = first; i < last; ++i) draw_item(frame, items[i], buffers, emission);
    }
    glDisable(GL_CULL_FACE);
}

void GeometryPass::draw_item(const Frame& frame, const DrawItem& item, const gpu::MeshBuffers& buffers,
                             bool emission) {
    const Material& m = item.material;
    const bool with_uv = item.textured();
    const bool face_normal = item.style.flat || (item.two_sided && !buffers.normals_agree);
    const Mat4d mesh_matrix = item.object->T_world_mesh.matrix();
    const Mat3d linear = mesh_matrix.topLeftCorner<3, 3>();
    const bool mirrored = linear.determinant() < 0;

    std::vector<std::string> defines;
    if (item.with_colors) defines.emplace_back("VERTEX_COLOR");
    if (with_uv) defines.emplace_back("UV");
    if (face_normal) defines.emplace_back("FACE_NORMAL");
    if (item.style.flat) defines.emplace_back("FLAT");
    if (item.two_sided) defines.emplace_back("TWO_SIDED");
    if (emission) defines.emplace_back("EMISSION");
    if (frame.with_ids) defines.emplace_back("OBJECT_ID");
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.alpha == AlphaMode::blend) defines.emplace_back(frame.peel ? "ALPHA_BLEND" : "ALPHA_STOCHASTIC");
    if (frame.peel) defines.emplace_back("PEEL");
    if (with_uv)
        for (const TextureUse& use : texture_uses)
            if ((m.*use.member) && !(use.slot == normal_slot && item.style.flat))
                defines.emplace_back(use.define);
    if (with_uv && m.metallic_texture && m.roughness_texture &&
        same_texels(m.metallic_texture, m.roughness_texture))
        defines.emplace_back("ROUGHNESS_IN_METALLIC");

    const gl::Program& program = programs_.get(defines);
    program.use();
    const Mat4d view_from_mesh = frame.camera.view() * mesh_matrix;
    program.set("u_clip_from_mesh", Mat4((frame.clip_from_view * view_from_mesh).cast<float>()));
    program.set("u_view_from_mesh", Mat4(view_from_mesh.cast<float>()));
    program.set("u_world_from_view", Mat3(frame.camera.T_world_cam.linear().cast<float>()));
    program.set("u_normal_from_mesh", Mat3(linear.inverse().transpose().cast<float>()));
    program.set("u_tangent_from_mesh", Mat3(linear.cast<float>()));
    program.set("u_base_color", Vec4(m.base_color.x(), m.base_color.y(), m.base_color.z(), m.opacity));
    program.set("u_surface", Vec4(m.metallic, m.roughness, m.occlusion_strength, m.alpha_cutoff));
    program.set("u_emissive", Vec4(m.emissive.x(), m.emissive.y(), m.emissive.z(),
                                   m.unlit ? code_of(SurfaceKind::unlit) : code_of(item.kind)));
    program.set("u_first_face", item.part.first_face);
    program.set("u_normal_scale", m.normal_scale);
    program.set("u_object_id", int(item.object - frame.scene->objects.data()) + 1);
    program.set("u_sample_index", float(frame.sample_index));
    // Jittered frames see finer detail together than one alone: a level less of blur from four samples on.
    program.set("u_lod_bias", frame.sample_count >= 4 ? -1.0f : 0.0f);
    if (with_uv) bind_textures(program, m);
    if (frame.peel) set_peel_uniforms(program, *frame.peel, peel_unit);

    set_culling(
        !item.two_sided || (buffers.closed_outward && item.alpha == AlphaMode::opaque && !item.style.flat),
        mirrored);
    buffers.array.bind();
    glDrawElements(GL_TRIANGLES, item.part.face_count * 3, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(size_t(item.part.first_face) * 12));
}

void GeometryPass::bind_textures(const gl::Program& program, const Material& material) {
    for (const TextureUse& use : texture_uses) {
        const Texture& texture = material.*use.member;
        if (!texture) continue;
        textures_.get(texture, use.color).bind(use.slot);
        program.set(use.sampler, int(use.slot));
        if (use.channel) program.set(use.channel, channel_mask(texture.channel));
        program.set("u_uv_transform[" + std::to_string(int(use.slot)) + "]", texture.uv_transform);
    }
}

}  // namespace easypbr::render
