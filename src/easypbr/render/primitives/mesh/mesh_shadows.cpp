#include "easypbr/render/primitives/mesh/mesh_shadows.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "easypbr/render/frame/own_shader.h"
#include "easypbr/render/primitives/mesh/mesh_material.h"

namespace easypbr::render {
namespace {

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

bool has_shader(const DrawItem* item) {
    return item->material.shader.operator bool();
}
bool is_solid(const DrawItem* item) {
    return item->alpha == AlphaMode::opaque;
}

/// Opaque parts whose faces follow each other, as one.
std::vector<MeshPart> opaque_runs_of(Parts parts) {
    std::vector<MeshPart> runs;
    for (const DrawItem* item : parts) {
        if (!is_solid(item)) continue;
        const MeshPart& part = item->part;
        if (!runs.empty() && runs.back().first_face + runs.back().face_count == part.first_face)
            runs.back().face_count += part.face_count;
        else
            runs.push_back(part);
    }
    return runs;
}

}  // namespace

void MeshShadows::rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths) {
    Casters left;
    for (const Parts& parts : objects_of(casters)) {
        const bool native = std::ranges::none_of(parts, has_shader) && rasterise_opaque(view, parts, depths);
        if (!native) {
            left.insert(left.end(), parts.begin(), parts.end());
            continue;
        }
        for (const DrawItem* item : parts)
            if (!is_solid(item)) rasterise_masked(view, *item, depths);
    }
    casters = std::move(left);
}

bool MeshShadows::rasterise_opaque(const ShadowView& view, std::span<const DrawItem* const> parts,
                                   ShadowDepths& depths) const {
    const DrawItem& first = *parts.front();
    const MeshData& mesh = first.mesh();
    const ShadowLayer layer{view};
    // What is closed casts with what faces the light: behind each of its back faces lies nothing nearer.
    // A light within it has some of its vertices behind it: then both sides cast.
    const bool both_sides = !closed_.is_known(mesh) || !std::ranges::all_of(parts, is_solid),
               turned = view.R_light_world.determinant() < 0,  // three faces of a cube
        mirrored = (first.object->T_world_mesh.linear().determinant() < 0) != turned;
    return std::ranges::all_of(opaque_runs_of(parts), [&](const MeshPart& run) {
        ScreenTriangles triangles{mesh.V,
                                  mesh.F,
                                  run.first_face,
                                  run.face_count,
                                  layer.clip_from_mesh(first),
                                  both_sides,
                                  mirrored,
                                  both_sides,
                                  native_.clusters_of(mesh, run)};
        if (depths.buffer().draw(triangles)) return true;
        triangles.both_sides = triangles.clips = true;
        return depths.buffer().draw(triangles);
    });
}

gpu::Winding MeshShadows::winding_of(const DrawItem& item) {
    return item.is_volume() ? closed_.find(item.mesh()) : gpu::Winding::unknown;
}

CasterSurface MeshShadows::surface_of(const ShadowView& view, int resolution, const DrawItem& item) {
    const float* colors = item.with_colors ? native_.colors_of(item.mesh()) : nullptr;
    return {view, resolution, item, winding_of(item), textures_, colors};
}

namespace {

/// Both sides of all faces, clipped.
ScreenTriangles all_triangles(const ShadowView& view, const DrawItem& item) {
    return {item.mesh().V,
            item.mesh().F,
            item.part.first_face,
            item.part.face_count,
            ShadowLayer{view}.clip_from_mesh(item),
            true,
            false,
            true};
}

}  // namespace

void MeshShadows::rasterise_masked(const ShadowView& view, const DrawItem& item, ShadowDepths& depths) {
    const int resolution = depths.resolution();
    const CasterSurface surface = surface_of(view, resolution, item);
    const AlphaTest test{[&](std::span<const native::VisiblePixel> texels, std::span<float> alpha) {
                             surface.alpha(texels, alpha);
                         },
                         item.material.alpha_cutoff};
    masked_.clear({resolution, resolution}, {0, 0, resolution, resolution});
    masked_.draw(all_triangles(view, item), 0, &test);
    depths.buffer().add(masked_);
}

void MeshShadows::rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer) {
    for (const DrawItem* item : casters) {
        const CasterSurface surface = surface_of(view, layer.resolution(), *item);
        const auto shade = [&](std::span<const native::VisiblePixel> texels, std::span<float> values) {
            surface.shade(texels, values);
        };
        if (casts_by_texture(*item) || item->with_colors) {
            layer.draw(all_triangles(view, *item), TexelAbsorption(shade));
            continue;
        }
        std::array<float, 4> same;
        shade(std::array{native::VisiblePixel{}}, same);
        layer.draw(all_triangles(view, *item), Vec3(same[0], same[1], same[2]));
    }
}

bool MeshShadows::has_native_tints(std::span<const DrawItem> items) {
    return std::ranges::none_of(items, [](const DrawItem& item) { return has_shader(&item); });
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
    const gl::Program& program = programs_.get(mesh_caster_defines(item));
    program.use();
    program.set("u_clip_from_mesh", layer.clip_from_mesh(item));
    caster_inputs(item, winding_of(item), textures_, false).bind(program);
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
    const float share = share_of_face(item, winding_of(item));
    program.set("u_through", light_through(item, share));
    program.set("u_root", share);
    const unsigned unit = material_inputs(core_model, item, textures_).bind(program);
    if (varies) {
        textures_.get(m.transmission_texture, gpu::TexelKind::data, "transmission_texture").bind(unit);
        program.set("u_transmission_texture", int(unit));
        program.set("u_transmission_uv", m.transmission_texture.uv_transform);
        program.set("u_transmission_channel",
                    Vec4(Vec4::Unit(std::clamp(m.transmission_texture.channel, 0, 3))));
    }
}

}  // namespace easypbr::render
