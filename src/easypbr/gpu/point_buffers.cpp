#include "easypbr/gpu/point_buffers.h"

#include "easypbr/gpu/mesh_buffers.h"
#include "easypbr/gpu/packing.h"

namespace easypbr::gpu {
namespace {

PointBuffers make_buffers(const MeshData& mesh) {
    PointBuffers buffers;
    buffers.positions = gl::Buffer(std::as_bytes(std::span(mesh.V.data(), size_t(mesh.V.size()))));
    buffers.array = gl::VertexArray::make();
    buffers.array.attribute(position_location, buffers.positions, 3, gl::AttributeType::f32, 12);
    if (!mesh.N.empty()) {
        buffers.normals =
            converted<Oct16>(mesh.N.rows(), [&](Eigen::Index i) { return oct16(mesh.N.row(i).transpose()); });
        buffers.array.attribute(normal_location, buffers.normals, 2, gl::AttributeType::snorm16, 4);
    }
    if (!mesh.C.empty()) {
        buffers.colors = converted<Rgba8>(mesh.C.rows(), [&](Eigen::Index i) { return rgba8(mesh.C, i); });
        buffers.array.attribute(color_location, buffers.colors, 4, gl::AttributeType::unorm8, 4);
    }
    return buffers;
}

}  // namespace

const PointBuffers& PointCache::get(const MeshData& mesh) {
    return buffers_.get({mesh.V.revision(), mesh.N.revision(), mesh.C.revision()},
                        [&] { return make_buffers(mesh); });
}

}  // namespace easypbr::gpu
