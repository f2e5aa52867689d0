#include "easypbr/render/shadow/shadow_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/gl/context.h"
#include "easypbr/render/frame/own_shader.h"
#include "easypbr/render/primitives/mesh/mesh_material.h"

namespace easypbr::render {
namespace {

enum Slot { base_color_slot, opacity_slot, transmission_slot };

bool reads_uv(const DrawItem& item) {
    const Material& m = item.material;
    const bool any =
        m.base_color_texture || m.opacity_texture || (item.casts_tint() && m.transmission_texture);
    return (item.alpha != AlphaMode::opaque || item.casts_tint()) && item.textured() && any;
}

/// Smaller objects are left to the driver, which fills large triangles in parallel; where exactly the two
/// break even has not been measured.
constexpr Eigen::Index smallest_face_count = 5000;

bool suits_native(std::span<const DrawItem> items) {
    const auto opaque = [](const DrawItem& item) {
        return item.alpha == AlphaMode::opaque && !item.material.shader;
    };
    return items.front().mesh().F.rows() >= smallest_face_count && std::ranges::all_of(items, opaque);
}

/// The largest depth stays, whatever the order: no depth buffer is needed. Tints add up, and keep the first
/// and the last caster's depths in alpha.
gl::DrawState caster_state(bool tints) {
    if (!tints) return {.blending = gl::maximum};
    return {.blending = {.source = gl::Factor::one,
                         .target = gl::Factor::one,
                         .color_equation = gl::BlendEquation::add,
                         .alpha_equation = gl::BlendEquation::maximum}};
}

/// The solid items of each object, or those that tint; they follow each other.
std::vector<std::span<const DrawItem>> objects_of(std::span<const DrawItem> items, bool tints) {
    std::vector<std::span<const DrawItem>> objects;
    for (size_t first = 0, last; first < items.size(); first = last) {
        const auto same = [&](const DrawItem& item) {
            return item.object == items[first].object && item.casts_tint() == items[first].casts_tint();
        };
        for (last = first; last < items.size() && same(items[last]);) ++last;
        if (items[first].casts_tint() == tints) objects.push_back(items.subspan(first, last - first));
    }
    return objects;
}

/// Part of light that goes through what is covered, but for colours that vary over the surface. Light crosses
/// the faces of a volume twice, and each takes the root.
Vec3 light_through(const DrawItem& item) {
    if (item.kind != SurfaceKind::lit) return Vec3::Zero();
    Material m = item.material;
    m.thickness *= float(std::cbrt(std::abs(item.object->T_world_mesh.linear().determinant())));
    const Vec3 through = m.transmittance(AlphaMode::opaque);
    return m.thickness > 0 ? Vec3(through.cwiseSqrt()) : through;
}

}  // namespace

void ShadowPass::draw(const ShadowView& view, const DrawList& casters, gl::Texture& maps, int layer,
                      const gl::Framebuffer& framebuffer) {
    std::vector<Items> objects = objects_of(casters.meshes, false);
    const bool native = native_ && gl::Context::current().info().software;
    const bool native_points = native && std::ranges::any_of(casters.points, SplatShadows::suits_native);
    if (native && (native_points || std::ranges::any_of(objects, suits_native))) {
        objects = draw_native(view, objects, casters.points, maps, layer);
    } else {
        const float nothing[4] = {no_shadow_depth, 0, 0, 0};
        framebuffer.clear_color(0, nothing);
    }
    if (objects.empty() && casters.points.empty() && casters.surfels.empty()) return;
    framebuffer.bind();
    for (const Items& items : objects) draw_object(view, items);
    draw_splats(view, casters, false, native, maps.width());
}

void ShadowPass::draw_tints(const ShadowView& view, const DrawList& casters,
                            const gl::Framebuffer& framebuffer) {
    const float nothing[4] = {0, 0, 0, no_shadow_depth};
    framebuffer.clear_color(0, nothing);
    framebuffer.clear_color(1, nothing);
    framebuffer.bind();
    for (const Items& items : objects_of(casters.meshes, true)) draw_object(view, items);
    draw_splats(view, casters, true, false, framebuffer.width());
}

std::vector<ShadowPass::Items> ShadowPass::draw_native(const ShadowView& view,
                                                       const std::vector<Items>& objects, Items clouds,
                                                       gl::Texture& maps, int layer) {
    const int size = maps.width();
    depths_.clear(Vec2i(size, size), no_shadow_depth);
    std::vector<Items> left;
    for (const Items& items : objects) {
        const MeshData& mesh = items.front().mesh();
        const Mat4 clip_from_mesh =
            (view.clip_from_world() * items.front().object->T_world_mesh.matrix()).cast<float>();
        // What is closed casts with what faces the light: behind each of its back faces lies nothing nearer.
        // A light within it is not drawn here, for some of its vertices are behind it.
        const bool both_sides = !closed_.is_known(mesh),
                   mirrored = items.front().object->T_world_mesh.linear().determinant() < 0;
        if (!suits_native(items) ||
            !depths_.draw({mesh.V, mesh.F, 0, int(mesh.F.rows()), clip_from_mesh, both_sides, mirrored}))
            left.push_back(items);
    }
    if (std::ranges::any_of(clouds, SplatShadows::suits_native)) {
        points_.clear(Vec2i(size, size), {0, 0, size, size});
        for (const DrawItem& item : clouds)
            if (SplatShadows::suits_native(item)) splats_.draw_points_natively(view, item, points_);
        depths_.add(points_);
    }
    maps.upload(std::as_bytes(depths_.bits()), 0, layer);
    return left;
}

void ShadowPass::draw_splats(const ShadowView& view, const DrawList& casters, bool tints, bool native,
                             int resolution) {
    for (const DrawItem& item : casters.points)
        if (item.casts_tint() == tints && (!native || !SplatShadows::suits_native(item)))
            splats_.draw_points(view, item, resolution, caster_state(tints));
    for (const DrawItem& item : casters.surfels)
        if (item.casts_tint() == tints) splats_.draw_surfels(view, item, caster_state(tints));
}

void ShadowPass::draw_object(const ShadowView& view, Items items) {
    // The buffers that the geometry pass draws an object from serve here too.
    const bool tangents = std::ranges::any_of(items, &DrawItem::needs_tangents);
    const gl::VertexArray& array = meshes_.get(items.front().mesh(), tangents).array;
    for (const DrawItem& item : items) {
        if (item.material.shader)
            use_own_shader(view, item);
        else
            use_shader(view, item);
        gl::draw_triangles(caster_state(item.casts_tint()), array, int64_t(item.part.first_face) * 3,
                           item.part.face_count * 3);
    }
}

void ShadowPass::use_shader(const ShadowView& view, const DrawItem& item) {
    const Material& m = item.material;
    const bool with_uv = reads_uv(item), tints = item.casts_tint();
    std::vector<std::string> defines;
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.alpha == AlphaMode::opaque) defines.emplace_back("COVERS");
    if (tints) defines.emplace_back("TINT");
    if ((item.alpha != AlphaMode::opaque || tints) && item.with_colors) defines.emplace_back("VERTEX_COLOR");
    if (with_uv) defines.emplace_back("UV");
    if (with_uv && m.base_color_texture) defines.emplace_back("BASE_COLOR_TEXTURE");
    if (with_uv && m.opacity_texture) defines.emplace_back("OPACITY_TEXTURE");
    if (with_uv && tints && m.transmission_texture) defines.emplace_back("TRANSMISSION_TEXTURE");
    const gl::Program& program = programs_.get(defines);
    program.use();
    const Mat4d clip_from_mesh = view.clip_from_world() * item.object->T_world_mesh.matrix();
    program.set("u_clip_from_mesh", Mat4(clip_from_mesh.cast<float>()));
    program.set("u_opacity", m.opacity);
    program.set("u_alpha_cutoff", m.alpha_cutoff);
    program.set("u_through", light_through(item));
    program.set("u_root", item.is_volume() ? 0.5f : 1.0f);
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
    if (with_uv && tints && m.transmission_texture) {
        bind(m.transmission_texture, transmission_slot, "u_transmission_texture", "u_transmission_uv");
        program.set("u_transmission_channel",
                    Vec4(Vec4::Unit(std::clamp(m.transmission_texture.channel, 0, 3))));
    }
}

void ShadowPass::use_own_shader(const ShadowView& view, const DrawItem& item) {
    const Material& m = item.material;
    const bool tints = item.casts_tint();
    const bool varies = tints && item.textured() && m.transmission_texture;
    const MaterialContext core_model;
    // The face's side by its derivatives: nothing is known of the winding here.
    std::vector<std::string> defines = {"SURFACE_SHADER", "FACE_NORMAL"};
    if (item.style.flat) defines.emplace_back("FLAT");
    if (item.with_colors) defines.emplace_back("VERTEX_COLOR");
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (item.alpha == AlphaMode::opaque) defines.emplace_back("COVERS");
    if (tints) defines.emplace_back("TINT");
    if (varies) defines.emplace_back("TRANSMISSION_TEXTURE");
    add_material_defines(core_model, item, defines);
    const gl::Program& program = with_shader(shaded_, m.shader, defines);
    program.use();
    const Eigen::Affine3d& T = item.object->T_world_mesh;
    const Vec3d along = view.R_light_world.row(2);
    // A parallel view is from so far before all casters that it looks nearly straight at each.
    const Vec3d eye = view.perspective
                          ? view.position
                          : Vec3d(view.position + along * (view.near - 8 * (view.far - view.near)));
    const Mat4d view_from_mesh = (Eigen::Translation3d(-eye) * T).matrix();
    program.set("u_clip_from_mesh", Mat4((view.clip_from_world() * T.matrix()).cast<float>()));
    program.set("u_view_from_mesh", Mat4(view_from_mesh.cast<float>()));
    program.set("u_world_from_view", Mat3(Mat3::Identity()));
    program.set("u_normal_from_mesh", Mat3(T.linear().inverse().transpose().cast<float>()));
    program.set("u_tangent_from_mesh", Mat3(T.linear().cast<float>()));
    program.set("u_eye", Vec3(eye.cast<float>()));
    program.set("u_backwards",
                Vec4(float(-along.x()), float(-along.y()), float(-along.z()), view.perspective ? 0 : 1));
    program.set("u_through", light_through(item));
    program.set("u_root", item.is_volume() ? 0.5f : 1.0f);
    const unsigned unit = set_material(program, core_model, item, textures_);
    if (varies) {
        textures_.get(m.transmission_texture, false).bind(unit);
        program.set("u_transmission_texture", int(unit));
        program.set("u_transmission_uv", m.transmission_texture.uv_transform);
        program.set("u_transmission_channel",
                    Vec4(Vec4::Unit(std::clamp(m.transmission_texture.channel, 0, 3))));
    }
}

}  // namespace easypbr::render
