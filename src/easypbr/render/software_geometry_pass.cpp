#include "easypbr/render/software_geometry_pass.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/scene/normals.h"
#include "easypbr/scene/spacing.h"

namespace easypbr::render {
namespace {

/// Small meshes alone are left to the driver; where exactly the two break even has not been measured.
constexpr int64_t smallest_face_count = 5000;

uint16_t unorm16(float v) {
    return uint16_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
}
uint8_t unorm8(float v) {
    return uint8_t(std::lrintf(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

/// The frames of one picture are jittered by up to a pixel, and edges are smoothed one pixel beyond them.
PixelRect with_margin(const PixelRect& r, Vec2i size) {
    constexpr int margin = 2;
    if (r.width == 0) return {};
    const int x0 = std::max(0, r.x - margin), y0 = std::max(0, r.y - margin);
    return {x0, y0, std::min(size.x(), r.x + r.width + margin) - x0,
            std::min(size.y(), r.y + r.height + margin) - y0};
}

}  // namespace

/// An item and the numbers of its primitives.
struct SoftwareGeometryPass::Surface {
    uint32_t first_id;
    const DrawItem* item;
    std::optional<MeshSurface> mesh;
    std::optional<PointSurface> points;
};

void SoftwareGeometryPass::Pixels::resize(size_t count, bool with_ids) {
    albedo.resize(count * 4);
    normal.resize(count * 2);
    material.resize(count * 4);
    depth.resize(count);
    id.resize(with_ids ? count : 0);
    element.resize(with_ids ? count : 0);
}

bool SoftwareGeometryPass::handles(const DrawList& list) {
    int64_t faces = 0, points = 0;
    for (const DrawItem& item : list.meshes) {
        if (item.textured() || item.emits() || item.alpha != AlphaMode::opaque) return false;
        faces += item.part.face_count;
    }
    if (!handles_points(list)) return false;
    for (const DrawItem& item : list.points) points += item.mesh().V.rows();
    return (points > 0 || faces >= smallest_face_count) && faces + points < int64_t(UINT32_MAX);
}

bool SoftwareGeometryPass::handles_points(const DrawList& list) {
    return std::ranges::all_of(list.points,
                               [](const DrawItem& item) { return item.alpha == AlphaMode::opaque; });
}

const MeshKnowledge& SoftwareGeometryPass::knowledge_of(const MeshData& mesh) {
    MeshKnowledge& known = knowledge_[{mesh.V.revision(), mesh.N.revision(), mesh.F.revision()}];
    known.used = true;
    if (known.N.empty()) {
        known.N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
        known.normals_agree = mesh.N.empty() || gpu::normals_agree_with_winding(mesh.V, known.N, mesh.F);
    }
    // A serial pass over the faces that a single picture would not earn back: a still of one sample goes
    // without.
    if (++known.frames == 2) known.closed_outward = gpu::is_closed_outward(mesh.V, mesh.F);
    return known;
}

double SoftwareGeometryPass::spacing_of(const MeshData& mesh) {
    const auto [entry, is_new] = spacings_.try_emplace(mesh.V.revision());
    if (is_new) entry->second.value = point_spacing(mesh.V);
    entry->second.used = true;
    return entry->second.value;
}

void SoftwareGeometryPass::evict_unused() {
    std::erase_if(knowledge_, [](const auto& item) { return !item.second.used; });
    for (auto& [key, known] : knowledge_) known.used = false;
    std::erase_if(spacings_, [](const auto& item) { return !item.second.used; });
    for (auto& [key, spacing] : spacings_) spacing.used = false;
}

bool SoftwareGeometryPass::add_meshes(const Frame& frame, const DrawList& list,
                                      std::vector<Surface>& surfaces) {
    uint32_t next_id = 0;
    for (const DrawItem& item : list.meshes) {
        const MeshData& mesh = item.mesh();
        const MeshKnowledge& known = knowledge_of(mesh);
        const Mat4d clip_from_mesh =
            frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix();
        const MeshSurface surface(item, known, clip_from_mesh);
        const bool both_sides = item.two_sided && (item.style.flat || !known.closed_outward);
        if (!visibility_.draw(mesh.V, mesh.F, item.part.first_face, item.part.face_count,
                              clip_from_mesh.cast<float>(), next_id, both_sides, surface.mirrored()))
            return false;
        surfaces.push_back({next_id, &item, surface, std::nullopt});
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
        const double spacing = item.style.point_size ? 0 : spacing_of(item.mesh());
        visibility_.draw_points(item.mesh().V, splats_of(item, frame, spacing), surfaces[i].first_id,
                                content);
    }
}

bool SoftwareGeometryPass::draw(Frame& frame, const DrawList& list, const GBuffer& targets) {
    visibility_.clear(frame.size, frame.covered);
    std::vector<Surface> surfaces;
    if (!add_meshes(frame, list, surfaces)) return false;
    add_points(frame, list, surfaces);
    visibility_.crop();
    resolve(frame, surfaces);
    targets.clear(frame.with_ids);
    upload(frame, targets);
    if (list.lines.empty()) frame.covered = with_margin(visibility_.area(), frame.size);
    return true;
}

void SoftwareGeometryPass::draw_points_over(const Frame& frame, const DrawList& list,
                                            const GBuffer& targets) {
    visibility_.clear(frame.size, frame.covered);
    std::vector<Surface> surfaces;
    add_points(frame, list, surfaces);
    visibility_.crop();
    const PixelRect& r = visibility_.area();
    if (r.width == 0 || r.height == 0) return;
    resolve(frame, surfaces);
    if (!staging_.albedo || staging_.size() != frame.size) staging_ = GBuffer(frame.size);
    if (frame.with_ids) staging_.add_ids();
    upload(frame, staging_);

    std::vector<std::string> defines;
    if (frame.with_ids) defines.emplace_back("OBJECT_ID");
    const gl::Program& program = composite_.get(defines);
    (frame.with_ids ? targets.surface_ids : targets.surface_emission).bind();
    program.use();
    program.set("u_size", Vec2(frame.size.cast<float>()));
    const gl::Texture* sources[] = {&staging_.albedo, &staging_.normal, &staging_.material,
                                    &staging_.depth,  &staging_.id,     &staging_.element};
    const char* samplers[] = {"u_albedo", "u_normal", "u_material", "u_depth_target", "u_id", "u_element"};
    for (unsigned unit = 0; unit < (frame.with_ids ? 6u : 4u); ++unit) {
        sources[unit]->bind(unit);
        program.set(samplers[unit], int(unit));
    }
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    glEnable(GL_SCISSOR_TEST);
    glScissor(r.x, r.y, r.width, r.height);
    draw_screen_triangle();
    glDisable(GL_SCISSOR_TEST);
}

void SoftwareGeometryPass::resolve(const Frame& frame, const std::vector<Surface>& surfaces) {
    const PixelRect& area = visibility_.area();
    pixels_.resize(visibility_.pixels().size(), frame.with_ids);
    const double step_x = 2.0 / frame.size.x(), step_y = 2.0 / frame.size.y();
    const auto resolve_pixel = [&](size_t i, int x, int y) {
        const uint64_t pixel = visibility_.pixels()[i];
        pixels_.depth[i] = 0;
        if (frame.with_ids) pixels_.id[i] = pixels_.element[i] = 0;
        if (pixel == 0) return;
        const uint32_t id = VisibilityBuffer::id_of(pixel);
        const Surface& s =
            *std::prev(std::upper_bound(surfaces.begin(), surfaces.end(), id,
                                        [](uint32_t v, const Surface& t) { return v < t.first_id; }));
        const SurfacePixel p =
            s.mesh ? s.mesh->at(id - s.first_id, (x + 0.5) * step_x - 1, 1 - (y + 0.5) * step_y)
                   : s.points->at(id - s.first_id, VisibilityBuffer::depth_of(pixel));
        const Vec2 normal = oct_encode(p.normal) * 0.5f + Vec2(0.5f, 0.5f);
        const Material& m = s.item->material;
        pixels_.depth[i] = p.depth;
        for (size_t c = 0; c < 3; ++c) pixels_.albedo[4 * i + c] = unorm16(p.albedo[Eigen::Index(c)]);
        pixels_.albedo[4 * i + 3] = 65535;
        pixels_.normal[2 * i] = unorm16(normal.x());
        pixels_.normal[2 * i + 1] = unorm16(normal.y());
        const uint8_t material[4] = {unorm8(m.metallic), unorm8(m.roughness), 255, uint8_t(s.item->kind)};
        std::copy_n(material, 4, &pixels_.material[4 * i]);
        if (!frame.with_ids) return;
        pixels_.id[i] = uint32_t(s.item->object - frame.scene->objects.data()) + 1;
        pixels_.element[i] = p.element + 1;
    };
    parallel_for(size_t(area.height), 4, [&](size_t row) {
        for (int x = 0; x < area.width; ++x)
            resolve_pixel(row * size_t(area.width) + size_t(x), area.x + x, area.y + int(row));
    });
}

void SoftwareGeometryPass::upload(const Frame& frame, const GBuffer& targets) const {
    const PixelRect& r = visibility_.area();
    if (r.width == 0 || r.height == 0) return;
    const auto put = [&](const gl::Texture& texture, const auto& values) {
        texture.upload_area(r.x, r.y, r.width, r.height, std::as_bytes(std::span(values)));
    };
    put(targets.albedo, pixels_.albedo);
    put(targets.normal, pixels_.normal);
    put(targets.material, pixels_.material);
    put(targets.depth, pixels_.depth);
    put(targets.depth_test, pixels_.depth);
    if (!frame.with_ids) return;
    put(targets.id, pixels_.id);
    put(targets.element, pixels_.element);
}

}  // namespace easypbr::render
