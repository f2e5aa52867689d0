#include "easypbr/gpu/line_buffers.h"

#include <cstddef>

namespace easypbr::gpu {
namespace {

std::vector<Segment> segments_of(const MeshData& mesh, LineKind kind, float length) {
    switch (kind) {
        case LineKind::wireframe:
            return wireframe_segments(mesh);
        case LineKind::normals:
            return normal_segments(mesh, length);
        default:
            return edge_segments(mesh);
    }
}

LineBuffers make_buffers(const std::vector<Segment>& segments) {
    LineBuffers buffers;
    buffers.count = int(segments.size());
    if (segments.empty()) return buffers;
    buffers.segments = upload(segments);
    gl::VertexArray& array = buffers.array = gl::VertexArray::make();
    const auto attribute = [&](unsigned location, int components, gl::AttributeType type, size_t offset) {
        array.attribute(location, buffers.segments, components, type, sizeof(Segment), int(offset), 1);
    };
    attribute(0, 3, gl::AttributeType::f32, offsetof(Segment, a));
    attribute(1, 4, gl::AttributeType::unorm8, offsetof(Segment, color_a));
    attribute(2, 3, gl::AttributeType::f32, offsetof(Segment, b));
    attribute(3, 4, gl::AttributeType::unorm8, offsetof(Segment, color_b));
    return buffers;
}

}  // namespace

const LineBuffers& LineCache::get(const MeshData& mesh, LineKind kind, float length) {
    const Key key{mesh.V.revision(),
                  mesh.E.revision(),
                  mesh.F.revision(),
                  mesh.N.revision(),
                  mesh.C.revision(),
                  kind,
                  length};
    return buffers_.get(key, [&] { return make_buffers(segments_of(mesh, kind, length)); });
}

}  // namespace easypbr::gpu
