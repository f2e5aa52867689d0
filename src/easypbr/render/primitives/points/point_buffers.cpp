#include "easypbr/render/primitives/points/point_buffers.h"

#include "easypbr/gpu/packing.h"

namespace easypbr::render {
namespace {

/// As in shaders/geometry_points.vert.
enum PointLocation { point_position, point_normal, point_color };

PointBuffers make_point_buffers(const MeshData& mesh) {
    PointBuffers buffers;
    buffers.positions = gl::Buffer(std::as_bytes(std::span(mesh.V.data(), size_t(mesh.V.size()))));
    buffers.array = gl::VertexArray::make();
    buffers.array.attribute(point_position, buffers.positions, 3, gl::AttributeType::f32, 12);
    if (!mesh.N.empty()) {
        buffers.normals = gpu::converted<gpu::Oct16>(
            mesh.N.rows(), [&](Eigen::Index i) { return gpu::oct16(mesh.N.row(i).transpose()); });
        buffers.array.attribute(point_normal, buffers.normals, 2, gl::AttributeType::snorm16, 4);
    }
    if (!mesh.C.empty()) {
        buffers.colors =
            gpu::converted<Rgba8>(mesh.C.rows(), [&](Eigen::Index i) { return gpu::rgba8(mesh.C, i); });
        buffers.array.attribute(point_color, buffers.colors, 4, gl::AttributeType::unorm8, 4);
    }
    return buffers;
}

}  // namespace

const PointBuffers& PointCache::get(const MeshData& mesh) {
    return buffers_.get({mesh.V.revision(), mesh.N.revision(), mesh.C.revision()},
                        [&] { return make_point_buffers(mesh); });
}

}  // namespace easypbr::render
