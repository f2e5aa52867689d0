#include "easypbr/render/primitives/mesh/mesh_shadows.h"

#include <algorithm>
#include <span>
#include <utility>

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

using Parts = std::span<const DrawItem* const>;

/// The casters of each object.
std::vector<Parts> objects_of(const Casters& casters) {
    std::vector<Parts> objects;
    const Parts all(casters);
    for (size_t first = 0, last; first < all.size(); first = last) {
        for (last = first; last < all.size() && all[last]->object == all[first]->object;) ++last;
        objects.push_back(all.subspan(first, last - first));
    }
    return objects;
}

bool parts_suit_native(Parts parts) {
    const auto opaque = [](const DrawItem* item) {
        return item->alpha == AlphaMode::opaque && !item->material.shader;
    };
    return std::ranges::all_of(parts, opaque);
}

/// Parts whose faces follow each other, as one.
std::vector<MeshPart> runs_of(Parts parts) {
    std::vector<MeshPart> runs;
    for (const DrawItem* item : parts) {
        const MeshPart& part = item->part;
        if (!runs.empty() && runs.back().first_face + runs.back().face_count == part.first_face)
            runs.back().face_count += part.face_count;
        else
            runs.push_back(part);
    }
    return runs;
}

/// Part of light that goes through what is covered, but for colours that vary over the surface. Light crosses
/// the faces of a volume twice, and each takes the root.
Vec3 light_through(const DrawItem& item) {
    if (item.kind != SurfaceKind::lit) return Vec3::Zero();
    Material m = item.material;
    m.thickness *= float(item.scale());
    const Vec3 through = m.transmittance(AlphaMode::opaque);
    return m.thickness > 0 ? Vec3(through.cwiseSqrt()) : through;
}

}  // namespace

void MeshShadows::rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths) const {
    Casters left;
    const ShadowLayer layer{view};
    for (const Parts& parts : objects_of(casters)) {
        const DrawItem& first = *parts.front();
        const MeshData& mesh = first.mesh();
        // What is closed casts with what faces the light: behind each of its back faces lies nothing nearer.
        // A light within it has some of its vertices behind it: then both sides cast.
        const bool both_sides = !closed_.is_known(mesh),
                   mirrored = first.object->T_world_mesh.linear().determinant() < 0;
        const auto rasterised = [&](const MeshPart& run) {
            ScreenTriangles triangles{
                mesh.V,     mesh.F,   run.first_face, run.face_count, layer.clip_from_mesh(first),
                both_sides, mirrored, both_sides};
            if (depths.buffer().draw(triangles)) return true;
            triangles.both_sides = triangles.clips = true;
            return depths.buffer().draw(triangles);
        };
        if (!parts_suit_native(parts) || !std::ranges::all_of(runs_of(parts), rasterised))
            left.insert(left.end(), parts.begin(), parts.end());
    }
    casters = std::move(left);
}

void MeshShadows::draw(const ShadowLayer& layer, const Casters& casters) {
    for (const Parts& parts : objects_of(casters)) {
        // The buffers that the geometry pass draws an object from serve here too.
        const auto needs_tangents = [](const DrawItem* item) { return item->needs_tangents(); };
        const bool tangents = std::ranges::any_of(parts, needs_tangents);
        const gl::VertexArray& array = meshes_.get(parts.front()->mesh(), tangents).array;
        for (const DrawItem* item : parts) {
            if (item->material.shader)
                use_own_shader(layer, *item);
            else
                use_shader(layer, *item);
            gl::draw_triangles(layer.state(), array, int64_t(item->part.first_face) * 3,
                               item->part.face_count * 3);
        }
    }
}

void MeshShadows::use_shader(const ShadowLayer& layer, const DrawItem& item) {
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
    program.set("u_clip_from_mesh", layer.clip_from_mesh(item));
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

void MeshShadows::use_own_shader(const ShadowLayer& layer, const DrawItem& item) {
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
    const ShadowView& view = layer.view;
    const Vec3d along = view.R_light_world.row(2);
    // A parallel view is from so far before all casters that it looks nearly straight at each.
    const Vec3d eye = view.perspective
                          ? view.position
                          : Vec3d(view.position + along * (view.near - 8 * (view.far - view.near)));
    const Mat4d view_from_mesh = (Eigen::Translation3d(-eye) * T).matrix();
    program.set("u_clip_from_mesh", layer.clip_from_mesh(item));
    program.set("u_view_from_mesh", Mat4(view_from_mesh.cast<float>()));
    program.set("u_world_from_view", Mat3(Mat3::Identity()));
    program.set("u_normal_from_mesh", Mat3(T.linear().inverse().transpose().cast<float>()));
    program.set("u_tangent_from_mesh", Mat3(T.linear().cast<float>()));
    program.set("u_eye", Vec3(eye.cast<float>()));
    program.set("u_backwards",
                Vec4(float(-along.x()), float(-along.y()), float(-along.z()), view.perspective ? 0 : 1));
    program.set("u_through", light_through(item));
    program.set("u_root", item.is_volume() ? 0.5f : 1.0f);
    const unsigned unit = material_inputs(core_model, item, textures_).bind(program);
    if (varies) {
        textures_.get(m.transmission_texture, false).bind(unit);
        program.set("u_transmission_texture", int(unit));
        program.set("u_transmission_uv", m.transmission_texture.uv_transform);
        program.set("u_transmission_channel",
                    Vec4(Vec4::Unit(std::clamp(m.transmission_texture.channel, 0, 3))));
    }
}

}  // namespace easypbr::render
