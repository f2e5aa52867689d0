#include "easypbr/render/geometry_pass.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"

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

bool emits(const Material& material) {
    return material.unlit || !material.emissive.isZero();
}

bool is_drawn(const MeshData& mesh) {
    return mesh.style.visible && !mesh.F.empty();
}

/// The parts of a mesh; one part for all faces when it names none.
std::vector<MeshPart> parts_of(const MeshData& mesh) {
    if (!mesh.parts.empty()) return mesh.parts;
    return {MeshPart{{}, 0, int(mesh.F.rows()), 0}};
}

Material material_of(const MeshData& mesh, const MeshPart& part) {
    return size_t(part.material) < mesh.materials.size() ? mesh.materials[size_t(part.material)] : Material{};
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

Material overridden(const Material& material, const MaterialSettings& settings, const Material& textures) {
    Material m = material;
    if (settings.color.value()) m.base_color = linear_from_srgb(*settings.color);
    if (settings.metallic.value()) m.metallic = *settings.metallic;
    if (settings.roughness.value()) m.roughness = *settings.roughness;
    if (settings.emissive.value()) m.emissive = linear_from_srgb(*settings.emissive);
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
        if (m.emissive.isZero()) m.emissive = Vec3::Ones();
    });
    replace(m.normal_texture, textures.normal_texture, [] {});
    replace(m.occlusion_texture, textures.occlusion_texture, [] {});
    replace(m.opacity_texture, textures.opacity_texture, [&] {
        if (m.alpha_mode == AlphaMode::opaque) m.alpha_mode = AlphaMode::mask;
    });
    return m;
}

/// One part of one object with all that decides how it is drawn.
struct GeometryPass::Draw {
    const SceneSnapshot::Object* object;
    const gpu::MeshBuffers* buffers;
    MeshPart part;
    Material material;
    bool flat, two_sided, emission;
};

void GeometryPass::draw(const Frame& frame, const GBuffer& targets) {
    const Settings& settings = frame.resolved->settings;
    std::vector<Draw> draws;
    bool emission = false;
    for (const auto& object : frame.scene->objects) {
        if (!is_drawn(*object.mesh)) continue;
        const size_t first = draws.size();
        bool tangents = false;
        for (const MeshPart& part : parts_of(*object.mesh)) {
            Draw draw{&object, nullptr,
                      part,    overridden(material_of(*object.mesh, part), settings.material, overrides_),
                      false,   false,
                      false};
            const Style& style = object.mesh->style;
            draw.flat = settings.style.flat.value_or(style.flat.value_or(false));
            draw.two_sided =
                settings.style.two_sided.value_or(style.two_sided.value_or(draw.material.double_sided));
            emission |= emits(draw.material);
            tangents |= bool(draw.material.normal_texture) && !object.mesh->UV.empty();
            draws.push_back(std::move(draw));
        }
        const gpu::MeshBuffers& buffers = meshes_.get(*object.mesh, tangents);
        for (size_t i = first; i < draws.size(); ++i) draws[i].buffers = &buffers;
    }

    const gl::Framebuffer& framebuffer = emission ? targets.surface_emission : targets.surface;
    framebuffer.bind();
    glDepthMask(GL_TRUE);  // Clears obey the mask.
    const float zero[4] = {0, 0, 0, 0};
    framebuffer.clear_color(3, zero);
    framebuffer.clear_depth(0);
    targets.lit.clear_color(0, zero);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    for (Draw& draw : draws) {
        draw.emission = emission;
        draw_part(frame, draw);
    }
    glDisable(GL_CULL_FACE);
}

void GeometryPass::draw_part(const Frame& frame, const Draw& draw) {
    const gpu::MeshBuffers& buffers = *draw.buffers;
    const Material& m = draw.material;
    const bool with_uv = bool(buffers.uvs) && m.has_textures();
    const bool face_normal = draw.flat || (draw.two_sided && !buffers.normals_agree);
    const Mat4d mesh_matrix = draw.object->T_world_mesh.matrix();
    const Mat3d linear = mesh_matrix.topLeftCorner<3, 3>();
    const bool mirrored = linear.determinant() < 0;

    std::vector<std::string> defines;
    if (buffers.colors && !frame.resolved->settings.material.color.value())
        defines.emplace_back("VERTEX_COLOR");
    if (with_uv) defines.emplace_back("UV");
    if (face_normal) defines.emplace_back("FACE_NORMAL");
    if (draw.flat) defines.emplace_back("FLAT");
    if (draw.two_sided) defines.emplace_back("TWO_SIDED");
    if (draw.emission) defines.emplace_back("EMISSION");
    if (m.alpha_mode == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (m.alpha_mode == AlphaMode::blend) defines.emplace_back("ALPHA_BLEND");
    if (with_uv)
        for (const TextureUse& use : texture_uses)
            if ((m.*use.member) && !(use.slot == normal_slot && draw.flat)) defines.emplace_back(use.define);
    if (with_uv && m.metallic_texture && m.roughness_texture &&
        same_texels(m.metallic_texture, m.roughness_texture))
        defines.emplace_back("ROUGHNESS_IN_METALLIC");

    const gl::Program& program = programs_.get(defines);
    program.use();
    const Mat4d view_from_mesh = frame.resolved->camera.view() * mesh_matrix;
    program.set("u_clip_from_mesh", Mat4((frame.clip_from_view * view_from_mesh).cast<float>()));
    program.set("u_view_from_mesh", Mat4(view_from_mesh.cast<float>()));
    program.set("u_world_from_view", Mat3(frame.resolved->camera.T_world_cam.linear().cast<float>()));
    program.set("u_normal_from_mesh", Mat3(linear.inverse().transpose().cast<float>()));
    program.set("u_tangent_from_mesh", Mat3(linear.cast<float>()));
    program.set("u_base_color", Vec4(m.base_color.x(), m.base_color.y(), m.base_color.z(), m.opacity));
    program.set("u_surface", Vec4(m.metallic, m.roughness, m.occlusion_strength, m.alpha_cutoff));
    program.set("u_emissive", Vec4(m.emissive.x(), m.emissive.y(), m.emissive.z(), m.unlit ? 1.0f : 0.0f));
    program.set("u_normal_scale", m.normal_scale);
    program.set("u_sample_index", float(frame.sample_index));
    // Jittered frames see finer detail together than one alone: a level less of blur from four samples on.
    program.set("u_lod_bias", frame.sample_count >= 4 ? -1.0f : 0.0f);
    if (with_uv) bind_textures(program, m);

    set_culling(
        !draw.two_sided || (buffers.closed_outward && m.alpha_mode == AlphaMode::opaque && !draw.flat),
        mirrored);
    buffers.array.bind();
    glDrawElements(GL_TRIANGLES, draw.part.face_count * 3, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(size_t(draw.part.first_face) * 12));
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

void GeometryPass::evict_unused() {
    meshes_.evict_unused();
    textures_.evict_unused();
}

}  // namespace easypbr::render
