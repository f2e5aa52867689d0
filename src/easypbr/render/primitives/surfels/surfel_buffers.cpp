#include "easypbr/render/primitives/surfels/surfel_buffers.h"

#include <array>

#include "easypbr/gpu/packing.h"

namespace easypbr::render {
namespace {

/// As in shaders/geometry_surfels.vert.
enum Location { position_at, normal_at, color_at, axes_at };

SurfelBuffers make_surfel_buffers(const MeshData& mesh) {
    SurfelBuffers buffers;
    buffers.positions = gl::Buffer(std::as_bytes(std::span(mesh.V.data(), size_t(mesh.V.size()))));
    buffers.normals = gl::Buffer(std::as_bytes(std::span(mesh.N.data(), size_t(mesh.N.size()))));
    buffers.axes = gpu::converted<std::array<float, 4>>(mesh.V.rows(), [&](Eigen::Index i) {
        if (mesh.T.empty()) return std::array<float, 4>{};
        const Vec3 t = mesh.T.row(i);
        return std::array<float, 4>{t.x(), t.y(), t.z(), mesh.B.empty() ? t.norm() : mesh.B(i)};
    });
    gl::VertexArray& array = buffers.array = gl::VertexArray::make();
    array.attribute(position_at, buffers.positions, 3, gl::AttributeType::f32, 12, 0, 1);
    array.attribute(normal_at, buffers.normals, 3, gl::AttributeType::f32, 12, 0, 1);
    array.attribute(axes_at, buffers.axes, 4, gl::AttributeType::f32, 16, 0, 1);
    if (mesh.C.empty()) return buffers;
    buffers.colors =
        gpu::converted<Rgba8>(mesh.C.rows(), [&](Eigen::Index i) { return gpu::rgba8(mesh.C, i); });
    array.attribute(color_at, buffers.colors, 4, gl::AttributeType::unorm8, 4, 0, 1);
    return buffers;
}

}  // namespace

const SurfelBuffers& SurfelCache::get(const MeshData& mesh) {
    const Key key{mesh.V.revision(), mesh.N.revision(), mesh.T.revision(), mesh.B.revision(),
                  mesh.C.revision()};
    return buffers_.get(key, [&] { return make_surfel_buffers(mesh); });
}

}  // namespace easypbr::render
