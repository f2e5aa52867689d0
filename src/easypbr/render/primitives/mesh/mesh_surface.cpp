#include "easypbr/render/primitives/mesh/mesh_surface.h"

#include <utility>

namespace easypbr::render {

native::VisibleTriangles shading_triangles(const DrawItem& item, const MeshFacts& facts) {
    const MeshData& mesh = item.mesh();
    const Mat3d linear = item.object->T_world_mesh.linear();
    const Mat3 normal_from_mesh = linear.inverse().transpose().cast<float>();
    native::VisibleTriangles t;
    t.V = mesh.V.data();
    t.N = facts.N.data();
    t.F = mesh.F.data();
    t.first_face = uint32_t(item.part.first_face);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            t.normal_from_mesh[row][column] = normal_from_mesh(row, column);
            t.attributes.tangent_from_mesh[row][column] = float(linear(row, column));
        }
    t.flat = item.style.flat;
    t.two_sided = item.two_sided;
    t.normals_agree = facts.normals_agree;
    t.mirrored = linear.determinant() < 0;
    return t;
}

namespace {

/// See MeshSurface::vary().
void set_shader(native::VisibleTriangles& triangles, const void* shader, bool extended,
                const native::TriangleAttributes& attributes) {
    triangles.shader = shader;
    triangles.extended = extended;
    triangles.attributes.uvs = attributes.uvs;
    triangles.attributes.colors = attributes.colors;
    triangles.attributes.tangents = attributes.tangents;
}

}  // namespace

MeshSurface::MeshSurface(const Frame& frame, const DrawItem& item, const MeshFacts& facts,
                         const Mat4d& clip_from_mesh)
    : triangles_(shading_triangles(item, facts)) {
    // In double precision: not the snapped coordinates that decide visibility.
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            triangles_.clip_from_mesh[row][column] = clip_from_mesh(row, column);
    triangles_.pixel_width = 2.0 / frame.size.x();
    triangles_.pixel_height = 2.0 / frame.size.y();
}

void MeshSurface::vary(std::shared_ptr<const void> shader, bool extended,
                       const native::TriangleAttributes& attributes) {
    shader_ = std::move(shader);
    set_shader(triangles_, shader_.get(), extended, attributes);
}

void MeshSurface::alpha(std::span<const native::VisiblePixel> pixels, std::span<float> alpha) const {
    native::alpha_of_triangles(triangles_, pixels, alpha);
}

void MeshSurface::resolve(const Frame& frame, const DrawItem& item,
                          std::span<const native::VisiblePixel> pixels, SurfaceWriter& writer) const {
    native::VisibleTriangles triangles = triangles_;
    writer.set_targets(triangles, {.albedo = item.material.base_color,
                                   .metallic = item.material.metallic,
                                   .roughness = item.material.roughness,
                                   .kind = item.kind,
                                   .object = uint32_t(item.object - frame.scene->objects.data())});
    native::resolve_triangles(triangles, pixels);
}

MeshHits::MeshHits(const DrawItem& item, const MeshFacts& facts, std::shared_ptr<const void> shader,
                   const native::TriangleAttributes& attributes)
    : triangles_(shading_triangles(item, facts)), shader_(std::move(shader)) {
    set_shader(triangles_, shader_.get(), item.extensions() != 0, attributes);
}

void MeshHits::shade(std::span<const native::ElementHit> hits, const native::HitSurfaces& surfaces) const {
    native::shade_hits(triangles_, hits, surfaces);
}

}  // namespace easypbr::render
