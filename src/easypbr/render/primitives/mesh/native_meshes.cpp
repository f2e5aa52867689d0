#include "easypbr/render/primitives/mesh/native_meshes.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/gpu/packing.h"
#include "easypbr/render/primitives/mesh/mesh_material.h"
#include "easypbr/render/primitives/mesh/volume_side.h"
#include "easypbr/scene/normals.h"

namespace easypbr::render {
namespace {

Mat4d clip_from(const Frame& frame, const DrawItem& item) {
    return frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix();
}

ScreenTriangles triangles_of(const Frame& frame, const DrawItem& item, const MeshFacts& known,
                             const Mat4d& clip_from_mesh, bool backs) {
    const MeshData& mesh = item.mesh();
    const bool hides = item.alpha == AlphaMode::opaque && !item.material.transmits();
    // Of a volume the back is a part of what happens behind the front.
    const bool both_sides = item.two_sided && !item.is_volume() &&
                            (!hides || item.style.flat || known.winding != gpu::Winding::outward ||
                             !gpu::beyond_near_plane(frame.camera, item.object->T_world_mesh, known.box));
    const bool mirrored =
        (item.object->T_world_mesh.linear().determinant() < 0) != is_turned(frame, item, known.winding);
    return {mesh.V,
            mesh.F,
            item.part.first_face,
            item.part.face_count,
            clip_from_mesh.cast<float>(),
            both_sides,
            mirrored != backs,
            true};
}

/// Meshes of more vertices are culled by their clusters.
constexpr Eigen::Index small_mesh = 1 << 16;

/// What a box covers of a part of the picture.
ScreenBounds bounds_of(const Frame& frame, const PixelRect& area, const Mat4d& clip_from_mesh,
                       const Box3d& box) {
    constexpr double wider = 1.001;  // corners are rounded
    const SphereCulling culling(clip_from_mesh.cast<float>(), frame.size, area);
    const bool is_known = !box.isEmpty();
    const Vec3 center = is_known ? Vec3(box.center().cast<float>()) : Vec3(Vec3::Zero());
    const float radius =
        is_known ? float(wider * box.diagonal().norm() / 2) : std::numeric_limits<float>::infinity();
    return culling.drops(center, radius) ? ScreenBounds::nothing() : culling.bounds(center, radius);
}

/// Whether pixels of its triangles may be left out.
bool has_holes(const DrawItem& item) {
    return item.alpha == AlphaMode::mask ||
           (item.alpha == AlphaMode::blend && (item.with_colors || item.textured()));
}

std::vector<float> linear_colors(const ArrayXf& C) {
    std::vector<float> colors(4 * size_t(C.rows()));
    parallel_for(size_t(C.rows()), size_t(1) << 14, [&](size_t i) {
        const auto row = Eigen::Index(i);
        const Vec3 color = linear_from_srgb(Vec3(C.row(row).head<3>()));
        std::copy_n(color.data(), 3, &colors[4 * i]);
        colors[4 * i + 3] = C.cols() > 3 ? C(row, 3) : 1.0f;
    });
    return colors;
}

std::vector<int16_t> packed_tangents(const MeshData& mesh, const Array3f& N) {
    const ArrayXf corners = mesh_tangents(mesh, N);
    std::vector<int16_t> packed(size_t(corners.size()));
    parallel_for(packed.size(), size_t(1) << 16,
                 [&](size_t i) { packed[i] = gpu::snorm16(corners.data()[i]); });
    return packed;
}

}  // namespace

bool NativeMeshes::draws(DrawItems items) {
    return std::ranges::none_of(
        items, [](const DrawItem& item) { return item.material.shader || item.alpha == AlphaMode::blend; });
}

bool NativeMeshes::draws_layers(DrawItems items) {
    int64_t faces = 0;
    for (const DrawItem& item : items) {
        if (item.material.shader) return false;
        faces += item.part.face_count;
    }
    return faces < int64_t(UINT32_MAX);
}

const MeshFacts& NativeMeshes::facts_of(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    MeshFacts& known = facts_.get({mesh.V.revision(), mesh.N.revision(), mesh.F.revision()}, [&] {
        MeshFacts made;
        made.N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
        if (mesh.V.rows() <= small_mesh) made.box = gpu::box_of(mesh.V);
        made.normals_agree = mesh.N.empty() || gpu::normals_agree_with_winding(mesh.V, made.N, mesh.F);
        return made;
    });
    known.winding = closed_.draw(mesh, item.is_volume());
    if (known.winding == gpu::Winding::outward && known.box.isEmpty()) known.box = gpu::box_of(mesh.V);
    return known;
}

const float* NativeMeshes::colors_of(const MeshData& mesh) {
    return colors_.get(mesh.C.revision(), [&] { return linear_colors(mesh.C); }).data();
}

native::TriangleAttributes NativeMeshes::attributes_of(const DrawItem& item, const MeshFacts& known) {
    const MeshData& mesh = item.mesh();
    native::TriangleAttributes attributes;
    if (item.textured()) attributes.uvs = mesh.UV.data();
    if (item.with_colors) attributes.colors = colors_of(mesh);
    if (item.needs_tangents())
        attributes.tangents = tangents_
                                  .get({mesh.V.revision(), mesh.N.revision(), mesh.UV.revision(),
                                        mesh.uv_tangents.revision(), mesh.F.revision()},
                                       [&] { return packed_tangents(mesh, known.N); })
                                  .data();
    return attributes;
}

ShaderInputs NativeMeshes::inputs_of(const MaterialContext& context, const DrawItem& item,
                                     const MeshFacts& known) {
    ShaderInputs values = material_inputs(context, item, textures_, true);
    std::vector<std::string> defines;
    add_mesh_defines(item, known.normals_agree, defines);
    add_material_defines(context, item, defines);
    if (item.alpha == AlphaMode::blend) defines.emplace_back("ALPHA_BLEND");
    values.define(defines);
    return values;
}

std::unique_ptr<HitSurface> NativeMeshes::hit_surface(const ResolvedSettings& resolved,
                                                      const DrawItem& item) {
    const MeshFacts& known = facts_of(item);
    // Without a shader of its own, which is for pixels.
    DrawItem plain = item;
    plain.material.shader = {};
    // What the footprint of a ray blurs is not blurred less for being jittered.
    const ShaderInputs inputs = inputs_of({item.extensions(), 1, &resolved, false}, plain, known);
    Transfers none;
    const auto uniforms = item.extensions() ? native::extended_uniforms : native::surface_uniforms;
    return std::make_unique<MeshHits>(item, known, uniforms(inputs.native(none)),
                                      attributes_of(plain, known));
}

std::unique_ptr<MeshSurface> NativeMeshes::surface_of(const Frame& frame, const DrawItem& item,
                                                      ExtensionSet extensions, const MeshFacts& known,
                                                      const Mat4d& clip_from_mesh) {
    auto surface = std::make_unique<MeshSurface>(frame, item, known, clip_from_mesh);
    const bool is_extended = extensions && item.extensions();
    const bool is_plain = !item.textured() && !item.with_colors && !item.emits() && !is_extended &&
                          item.alpha == AlphaMode::opaque;
    if (is_plain) return surface;
    const MaterialContext context{extensions, frame.sample_count, frame.resolved, !frame.averages_radiance};
    const ShaderInputs inputs = inputs_of(context, item, known);
    Transfers none;
    const auto uniforms = is_extended ? native::extended_uniforms : native::surface_uniforms;
    surface->vary(uniforms(inputs.native(none)), is_extended, attributes_of(item, known));
    return surface;
}

bool NativeMeshes::rasterise(const Frame& frame, DrawItems items, ExtensionSet extensions,
                             VisibleSurfaces& surfaces) {
    VisibilityBuffer& buffer = surfaces.buffer();
    const bool backs = buffer.takes_backs();
    struct Waiting {
        const DrawItem* item;
        const MeshFacts* known;
        const MeshSurface* surface;
        uint32_t first_id;
        Mat4d clip_from_mesh;
        ScreenBounds bounds;
    };
    std::vector<Waiting> waiting;
    for (const DrawItem& item : items) {
        if (!surfaces.has_room(item.part.face_count)) return false;
        if (item.alpha == AlphaMode::blend && !(item.material.opacity > 0)) continue;
        if (backs && !item.is_volume()) continue;
        const MeshFacts& known = facts_of(item);
        const Mat4d clip_from_mesh = clip_from(frame, item);
        std::unique_ptr<MeshSurface> made = surface_of(frame, item, extensions, known, clip_from_mesh);
        const MeshSurface* const surface = made.get();
        const uint32_t first_id = surfaces.add(item, uint32_t(item.part.face_count), std::move(made));
        waiting.push_back({&item, &known, surface, first_id, clip_from_mesh,
                           bounds_of(frame, buffer.area(), clip_from_mesh, known.box)});
    }
    // What is near may hide others.
    std::ranges::stable_sort(waiting, std::greater(), [](const Waiting& w) { return w.bounds.nearest; });
    return std::ranges::all_of(waiting, [&](const Waiting& w) {
        const DrawItem& item = *w.item;
        ScreenTriangles triangles = triangles_of(frame, item, *w.known, w.clip_from_mesh, backs);
        triangles.clusters = clusters_.draw(item.mesh(), item.part);
        const AlphaTest test{
            [&](std::span<const native::VisiblePixel> pixels, std::span<float> alpha) {
                w.surface->alpha(pixels, alpha);
            },
            item.alpha == AlphaMode::blend ? std::numeric_limits<float>::min() : item.material.alpha_cutoff};
        return buffer.hides(w.bounds) ||
               buffer.draw(triangles, w.first_id, has_holes(item) ? &test : nullptr);
    });
}

void NativeMeshes::evict_unused() {
    facts_.evict_unused();
    clusters_.evict_unused();
    colors_.evict_unused();
    tangents_.evict_unused();
}

bool NativeMeshes::cover(const Frame& frame, DrawItems items, std::span<uint8_t> covered) {
    TriangleRaster raster;
    raster.set_area(frame.size, frame.whole());
    return std::ranges::all_of(items, [&](const DrawItem& item) {
        if (item.alpha != AlphaMode::opaque || item.material.shader) return false;
        return render::cover(raster, triangles_of(frame, item, facts_of(item), clip_from(frame, item), false),
                             covered);
    });
}

}  // namespace easypbr::render
