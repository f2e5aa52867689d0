#include "easypbr/render/shadow_pass.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace easypbr::render {
namespace {

enum Slot { base_color_slot, opacity_slot };

bool reads_uv(const DrawItem& item) {
    const Material& m = item.material;
    return item.alpha != AlphaMode::opaque && item.textured() && (m.base_color_texture || m.opacity_texture);
}

}  // namespace

void ShadowPass::draw(const ShadowView& view, const DrawList& casters, int sample_index,
                      const gl::Framebuffer& map) {
    map.bind();
    const float nothing[4] = {no_shadow_depth, 0, 0, 0};
    map.clear_color(0, nothing);
    // The largest depth stays, whatever the order: no depth buffer is needed.
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendEquation(GL_MAX);
    const std::vector<DrawItem>& items = casters.meshes;
    for (size_t first = 0, last; first < items.size(); first = last) {
        // The buffers that the geometry pass draws an object from serve here too.
        bool tangents = false;
        for (last = first; last < items.size() && items[last].object == items[first].object; ++last)
            tangents |= items[last].needs_tangents();
        meshes_.get(items[first].mesh(), tangents).array.bind();
        for (size_t i = first; i < last; ++i) draw_item(view, items[i], sample_index);
    }
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);
}

void ShadowPass::draw_item(const ShadowView& view, const DrawItem& item, int sample_index) {
    const Material& m = item.material;
    const bool with_uv = reads_uv(item);
    std::vector<std::string> defines;
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.alpha == AlphaMode::blend) defines.emplace_back("ALPHA_BLEND");
    if (item.alpha != AlphaMode::opaque && item.with_colors) defines.emplace_back("VERTEX_COLOR");
    if (with_uv) defines.emplace_back("UV");
    if (with_uv && m.base_color_texture) defines.emplace_back("BASE_COLOR_TEXTURE");
    if (with_uv && m.opacity_texture) defines.emplace_back("OPACITY_TEXTURE");
    const gl::Program& program = programs_.get(defines);
    program.use();
    const Mat4d clip_from_mesh = view.clip_from_world() * item.object->T_world_mesh.matrix();
    program.set("u_clip_from_mesh", Mat4(clip_from_mesh.cast<float>()));
    program.set("u_opacity", m.opacity);
    program.set("u_alpha_cutoff", m.alpha_cutoff);
    program.set("u_sample_index", float(sample_index));
    const auto bind = [&](const Texture& texture, Slot slot, const char* sampler, const char* transform) {
        textures_.get(texture, slot == base_color_slot).bind(slot);
        program.set(sampler, int(slot));
        program.set(transform, texture.uv_transform);
    };
    if (with_uv && m.base_color_texture)
        bind(m.base_color_texture, base_color_slot, "u_base_color_texture", "u_base_color_uv");
    if (with_uv && m.opacity_texture) {
        bind(m.opacity_texture, opacity_slot, "u_opacity_texture", "u_opacity_uv");
        program.set("u_opacity_channel", Vec4(Vec4::Unit(std::clamp(m.opacity_texture.channel, 0, 3))));
    }
    glDrawElements(GL_TRIANGLES, item.part.face_count * 3, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(size_t(item.part.first_face) * 12));
}

}  // namespace easypbr::render
