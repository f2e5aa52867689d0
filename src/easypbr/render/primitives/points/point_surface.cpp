#include "easypbr/render/primitives/points/point_surface.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {

PointSurface::PointSurface(const DrawItem& item, const Frame& frame, const PointOrder& order)
    : item_(&item), order_(order) {
    normal_from_mesh_ = item.object->T_world_mesh.linear().inverse().transpose().cast<float>();
    const Mat3d world_from_view = frame.camera.T_world_cam.linear();
    const Mat4d& p = frame.clip_from_view;
    // Of all rays of a perspective camera at a distance of 1 along the axis.
    const double wide = frame.orthographic() ? 0 : 1 / p(0, 0), high = frame.orthographic() ? 0 : 1 / p(1, 1);
    const Vec2d step(2.0 / frame.size.x(), -2.0 / frame.size.y());
    column_ = (-step.x() * wide * world_from_view.col(0)).cast<float>();
    row_ = (-step.y() * high * world_from_view.col(1)).cast<float>();
    towards_first_ = (world_from_view.col(2) - (step.x() / 2 - 1 + p(0, 2)) * wide * world_from_view.col(0) -
                      (step.y() / 2 + 1 + p(1, 2)) * high * world_from_view.col(1))
                         .cast<float>();
}

Vec3 PointSurface::color(uint32_t point) const {
    if (!item_->with_colors) return Vec3(1, 1, 1);
    return order_.colors ? order_.colors->at(point) : Vec3(item_->mesh().C.row(vertex_of(point)).head<3>());
}

void PointSurface::resolve(const Frame& frame, const DrawItem& item,
                           std::span<const native::VisiblePixel> pixels, SurfaceWriter& writer) const {
    // Neighbours on the screen may be far apart in memory: what they read is asked for ahead of their turn.
    constexpr size_t ahead = 16;
    const bool needs_vertex =
        writer.has_elements() || item.alpha == AlphaMode::blend || !item.mesh().N.empty();
    for (size_t i = 0; i < pixels.size(); ++i) {
        if (i + ahead < pixels.size()) prefetch(pixels[i + ahead].face);
        const native::VisiblePixel& p = pixels[i];
        const uint32_t vertex = needs_vertex ? vertex_of(p.face) : 0;
        SurfacePixel pixel;
        pixel.albedo = linear_from_srgb(color(p.face)).cwiseProduct(item.material.base_color);
        pixel.normal = normal(vertex, p.x, p.y);
        pixel.depth = p.depth;
        if (item.alpha == AlphaMode::blend) pixel.alpha = vertex_alpha(item, vertex);
        pixel.metallic = item.material.metallic;
        pixel.roughness = item.material.roughness;
        pixel.kind = kind_of_point(item.kind);
        pixel.object = uint32_t(item.object - frame.scene->objects.data());
        pixel.element = vertex;
        pixel.is_point = true;
        writer.put(writer.index(p.x, p.y), pixel);
    }
}

void PointSurface::prefetch(uint32_t point) const {
    const MeshData& mesh = item_->mesh();
    if (order_.colors)
        order_.colors->prefetch(point);
    else if (item_->with_colors)
        __builtin_prefetch(mesh.C.data() + size_t(mesh.C.cols()) * vertex_of(point));
    if (!mesh.N.empty()) __builtin_prefetch(mesh.N.data() + 3 * size_t(vertex_of(point)));
}

Vec3 PointSurface::normal(uint32_t vertex, int x, int y) const {
    const MeshData& mesh = item_->mesh();
    const Vec3 to_viewer = towards_viewer(x, y);
    if (mesh.N.empty()) return to_viewer.normalized();
    const Vec3 n = mesh.N.row(vertex);
    // A normal of no length tells nothing: the point faces the viewer.
    if (!(n.squaredNorm() > 0)) return to_viewer.normalized();
    const Vec3 world = (normal_from_mesh_ * n).normalized();
    return world.dot(to_viewer) < 0 ? Vec3(-world) : world;
}

PointRank PointSurface::rank(uint32_t point) const {
    const uint32_t vertex = vertex_of(point);
    const Vec3 c = color(point);
    const float values[4] = {c.x(), c.y(), c.z(), vertex_alpha(*item_, vertex)};
    uint64_t bits = 0;
    for (const float value : values)
        bits = bits << 8 | uint64_t(std::lrint(std::clamp(value, 0.0f, 1.0f) * 255.0f));
    if (item_->mesh().N.empty()) return {bits << 32, vertex};
    const Vec2 n = oct_encode(item_->mesh().N.row(vertex).transpose());
    for (int k = 0; k < 2; ++k) bits = bits << 16 | uint64_t(std::lrint((n[k] + 1) * 32767.5f));
    return {bits, vertex};
}

}  // namespace easypbr::render
