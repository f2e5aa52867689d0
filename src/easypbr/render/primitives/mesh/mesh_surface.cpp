#include "easypbr/render/primitives/mesh/mesh_surface.h"

#include <utility>

namespace easypbr::render {

MeshSurface::MeshSurface(const Frame& frame, const DrawItem& item, const MeshFacts& facts,
                         const Mat4d& clip_from_mesh) {
    const MeshData& mesh = item.mesh();
    const Mat3d linear = item.object->T_world_mesh.linear();
    const Mat3 normal_from_mesh = linear.inverse().transpose().cast<float>();
    native::VisibleTriangles& t = triangles_;
    t.V = mesh.V.data();
    t.N = facts.N.data();
    t.F = mesh.F.data();
    t.first_face = uint32_t(item.part.first_face);
    // In double precision: not the snapped coordinates that decide visibility.
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            t.clip_from_mesh[row][column] = clip_from_mesh(row, column);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            t.normal_from_mesh[row][column] = normal_from_mesh(row, column);
            t.attributes.tangent_from_mesh[row][column] = float(linear(row, column));
        }
    t.flat = item.style.flat;
    t.two_sided = item.two_sided;
    t.normals_agree = facts.normals_agree;
    t.mirrored = linear.determinant() < 0;
    t.pixel_width = 2.0 / frame.size.x();
    t.pixel_height = 2.0 / frame.size.y();
}

void MeshSurface::vary(std::shared_ptr<const void> shader, const native::TriangleAttributes& attributes) {
    shader_ = std::move(shader);
    triangles_.shader = shader_.get();
    triangles_.attributes.uvs = attributes.uvs;
    triangles_.attributes.colors = attributes.colors;
    triangles_.attributes.tangents = attributes.tangents;
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

}  // namespace easypbr::render
