#include "easypbr/render/raster/software_geometry_pass.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/scene/normals.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Small meshes alone are left to the driver; where exactly the two break even has not been measured.
constexpr int64_t least_native_faces = 5000;

/// The frames of one picture are jittered by up to a pixel, and edges are smoothed one pixel beyond them.
PixelRect with_margin(const PixelRect& r, Vec2i size) {
    constexpr int margin = 2;
    if (r.width == 0) return {};
    const int x0 = std::max(0, r.x - margin), y0 = std::max(0, r.y - margin);
    return {x0, y0, std::min(size.x(), r.x + r.width + margin) - x0,
            std::min(size.y(), r.y + r.height + margin) - y0};
}

Mat4d clip_from(const Frame& frame, const DrawItem& item) {
    return frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix();
}

ScreenTriangles triangles_of(const Frame& frame, const DrawItem& item, const MeshFacts& known,
                             const Mat4d& clip_from_mesh) {
    const MeshData& mesh = item.mesh();
    const bool both_sides =
        item.two_sided && (item.style.flat || !known.closed_outward ||
                           !gpu::beyond_near_plane(frame.camera, item.object->T_world_mesh, known.box));
    const bool mirrored = item.object->T_world_mesh.linear().determinant() < 0;
    return {mesh.V,     mesh.F,  item.part.first_face, item.part.face_count, clip_from_mesh.cast<float>(),
            both_sides, mirrored};
}

}  // namespace

/// An item and the numbers of its primitives.
struct SoftwareGeometryPass::Surface {
    uint32_t first_id;
    const DrawItem* item;
    std::optional<MeshSurface> mesh;
    std::optional<PointSurface> points;
};

bool SoftwareGeometryPass::handles(const DrawList& list) {
    int64_t faces = 0, points = 0;
    for (const DrawItem& item : list.meshes) {
        if (item.textured() || item.emits() || item.extensions() || item.alpha != AlphaMode::opaque)
            return false;
        faces += item.part.face_count;
    }
    if (!handles_points(list)) return false;
    for (const DrawItem& item : list.points) points += item.mesh().V.rows();
    return (points > 0 || faces >= least_native_faces) && faces + points < int64_t(UINT32_MAX);
}

bool SoftwareGeometryPass::handles_points(const DrawList& list) {
    return std::ranges::all_of(list.points,
                               [](const DrawItem& item) { return item.alpha == AlphaMode::opaque; });
}

const MeshFacts& SoftwareGeometryPass::facts_of(const MeshData& mesh) {
    MeshFacts& known = facts_.get({mesh.V.revision(), mesh.N.revision(), mesh.F.revision()}, [&] {
        MeshFacts made;
        made.N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
        made.normals_agree = mesh.N.empty() || gpu::normals_agree_with_winding(mesh.V, made.N, mesh.F);
        return made;
    });
    known.closed_outward = closed_.draw(mesh);
    if (known.closed_outward && known.box.isEmpty()) known.box = gpu::box_of(mesh.V);
    return known;
}

bool SoftwareGeometryPass::add_meshes(const Frame& frame, const DrawList& list,
                                      std::vector<Surface>& surfaces) {
    uint32_t next_id = 0;
    for (const DrawItem& item : list.meshes) {
        const MeshFacts& known = facts_of(item.mesh());
        const Mat4d clip_from_mesh = clip_from(frame, item);
        if (!visibility_.draw(triangles_of(frame, item, known, clip_from_mesh), next_id)) return false;
        surfaces.push_back({next_id, &item, MeshSurface(item, known, clip_from_mesh), std::nullopt});
        next_id += uint32_t(item.part.face_count);
    }
    return true;
}

void SoftwareGeometryPass::add_points(const Frame& frame, const DrawList& list,
                                      std::vector<Surface>& surfaces) {
    const size_t first_cloud = surfaces.size();
    uint32_t next_id =
        surfaces.empty() ? 0 : surfaces.back().first_id + uint32_t(surfaces.back().item->part.face_count);
    for (const DrawItem& item : list.points) {
        surfaces.push_back({next_id, &item, std::nullopt, PointSurface(item, frame)});
        next_id += uint32_t(item.mesh().V.rows());
    }
    const auto content = [&](uint32_t id) -> uint64_t {
        const auto surface =
            std::prev(std::upper_bound(surfaces.begin(), surfaces.end(), id,
                                       [](uint32_t v, const Surface& s) { return v < s.first_id; }));
        return surface->points ? surface->points->content(id - surface->first_id) : 0;
    };
    for (size_t i = first_cloud; i < surfaces.size(); ++i) {
        const DrawItem& item = *surfaces[i].item;
        const double spacing = item.style.point_size ? 0 : spacings_.get(item.mesh().V);
        visibility_.draw_points(item.mesh().V, splats_of(item, frame, spacing), surfaces[i].first_id,
                                content);
    }
}

std::optional<PixelRect> SoftwareGeometryPass::draw(const Frame& frame, const DrawList& list,
                                                    const GBuffer& targets, const SurfaceOutputs& outputs) {
    visibility_.clear(frame.size, frame.covered);
    std::vector<Surface> surfaces;
    if (!add_meshes(frame, list, surfaces)) return std::nullopt;
    add_points(frame, list, surfaces);
    visibility_.crop();
    resolve(frame, surfaces, outputs.ids);
    targets.clear(outputs.ids);
    pixels_.upload(targets);
    const bool is_all = list.lines.empty() && list.surfels.empty();
    return is_all ? with_margin(visibility_.area(), frame.size) : frame.covered;
}

void SoftwareGeometryPass::draw_points_over(const Frame& frame, const DrawList& list, const GBuffer& targets,
                                            const SurfaceOutputs& outputs) {
    visibility_.clear(frame.size, frame.covered);
    std::vector<Surface> surfaces;
    add_points(frame, list, surfaces);
    visibility_.crop();
    resolve(frame, surfaces, outputs.ids);
    composite_.draw(frame, pixels_, targets, outputs);
}

bool SoftwareGeometryPass::cover(const Frame& frame, const DrawList& list, std::vector<uint8_t>& covered) {
    const auto has_holes = [](const DrawItem& item) {
        return item.alpha != AlphaMode::opaque || item.material.shader;
    };
    if (!list.surfels.empty() || list.has(has_holes)) return false;
    const PixelRect area = frame.whole();
    TriangleRaster raster;
    raster.set_area(frame.size, area);
    for (const DrawItem& item : list.meshes)
        if (!render::cover(raster, triangles_of(frame, item, facts_of(item.mesh()), clip_from(frame, item)),
                           covered)) {
            std::ranges::fill(covered, uint8_t(0));
            return false;
        }
    if (list.points.empty()) return true;
    visibility_.clear(frame.size, area);
    std::vector<Surface> surfaces;
    add_points(frame, list, surfaces);
    for (size_t i = 0; i < covered.size(); ++i) covered[i] |= visibility_.pixels()[i] != 0;
    return true;
}

void SoftwareGeometryPass::resolve(const Frame& frame, const std::vector<Surface>& surfaces, bool ids) {
    const PixelRect& area = visibility_.area();
    pixels_.resize(area, ids);
    const double step_x = 2.0 / frame.size.x(), step_y = 2.0 / frame.size.y();
    const auto resolve_pixel = [&](size_t i, int x, int y) {
        const uint64_t found = visibility_.pixels()[i];
        if (found == 0) return pixels_.put_nothing(i);
        const uint32_t id = VisibilityBuffer::id_of(found);
        const Surface& s =
            *std::prev(std::upper_bound(surfaces.begin(), surfaces.end(), id,
                                        [](uint32_t v, const Surface& t) { return v < t.first_id; }));
        SurfacePixel pixel = s.mesh
                                 ? s.mesh->at(id - s.first_id, (x + 0.5) * step_x - 1, 1 - (y + 0.5) * step_y)
                                 : s.points->at(id - s.first_id, VisibilityBuffer::depth_of(found));
        pixel.metallic = s.item->material.metallic;
        pixel.roughness = s.item->material.roughness;
        pixel.kind = s.item->kind;
        pixel.object = uint32_t(s.item->object - frame.scene->objects.data());
        pixels_.put(i, pixel);
    };
    parallel_for(size_t(area.height), 4, [&](size_t row) {
        for (int x = 0; x < area.width; ++x)
            resolve_pixel(row * size_t(area.width) + size_t(x), area.x + x, area.y + int(row));
    });
}

}  // namespace easypbr::render
