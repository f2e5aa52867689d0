#include "easypbr/render/primitives/points/point_surface.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {

PointSurface::PointSurface(const DrawItem& item, const Frame& frame) : item_(&item) {
    const Camera& camera = frame.camera;
    const Eigen::Affine3d& T = item.object->T_world_mesh;
    normal_from_mesh_ = T.linear().inverse().transpose().cast<float>();
    world_from_mesh_ = T.linear().cast<float>();
    const Mat3d inverse = T.linear().inverse();
    view_position_ = (inverse * (camera.position() - T.translation())).cast<float>();
    view_direction_ = (inverse * camera.T_world_cam.linear().col(2)).cast<float>();
    orthographic_ = frame.orthographic();
}

Vec3 PointSurface::color(uint32_t point) const {
    return item_->with_colors ? Vec3(item_->mesh().C.row(point).head<3>()) : Vec3(1, 1, 1);
}

void PointSurface::resolve(const Frame& frame, const DrawItem& item,
                           std::span<const native::VisiblePixel> pixels, SurfaceWriter& writer) const {
    // Neighbours on the screen may be far apart in memory: what they read is asked for ahead of their turn.
    constexpr size_t ahead = 16;
    for (size_t i = 0; i < pixels.size(); ++i) {
        if (i + ahead < pixels.size()) prefetch(pixels[i + ahead].face);
        const native::VisiblePixel& p = pixels[i];
        SurfacePixel pixel = at(p.face);
        pixel.depth = p.depth;
        if (item.alpha == AlphaMode::blend) pixel.alpha = vertex_alpha(item, p.face);
        pixel.metallic = item.material.metallic;
        pixel.roughness = item.material.roughness;
        pixel.kind = item.kind;
        pixel.object = uint32_t(item.object - frame.scene->objects.data());
        writer.put(writer.index(p.x, p.y), pixel);
    }
}

void PointSurface::prefetch(uint32_t point) const {
    const MeshData& mesh = item_->mesh();
    __builtin_prefetch(mesh.V.data() + 3 * size_t(point));
    if (item_->with_colors) __builtin_prefetch(mesh.C.data() + size_t(mesh.C.cols()) * point);
    if (!mesh.N.empty()) __builtin_prefetch(mesh.N.data() + 3 * size_t(point));
}

SurfacePixel PointSurface::at(uint32_t point) const {
    const MeshData& mesh = item_->mesh();
    SurfacePixel pixel;
    pixel.albedo = linear_from_srgb(color(point)).cwiseProduct(item_->material.base_color);
    pixel.element = point;
    pixel.is_point = true;
    const Vec3 p = mesh.V.row(point);
    const Vec3 to_viewer = orthographic_ ? view_direction_ : Vec3(view_position_ - p);
    Vec3 n = mesh.N.empty() ? Vec3(0, 0, 0) : Vec3(mesh.N.row(point));
    if (n.dot(to_viewer) < 0) n = -n;
    // A normal of no length tells nothing: the point faces the viewer.
    pixel.normal = (n.squaredNorm() > 0 ? normal_from_mesh_ * n : world_from_mesh_ * to_viewer).normalized();
    return pixel;
}

uint64_t PointSurface::content(uint32_t point) const {
    const Vec3 c = color(point);
    const float values[4] = {c.x(), c.y(), c.z(), vertex_alpha(*item_, point)};
    uint64_t bits = 0;
    for (const float value : values)
        bits = bits << 8 | uint64_t(std::lrint(std::clamp(value, 0.0f, 1.0f) * 255.0f));
    if (item_->mesh().N.empty()) return bits << 32;
    const Vec2 n = oct_encode(item_->mesh().N.row(point).transpose());
    for (int k = 0; k < 2; ++k) bits = bits << 16 | uint64_t(std::lrint((n[k] + 1) * 32767.5f));
    return bits;
}

}  // namespace easypbr::render
