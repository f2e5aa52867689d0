#include "easypbr/render/primitives/lines/line_buffers.h"

#include <cstddef>

namespace easypbr::render {
namespace {

/// Length of normals, as a part of the mesh's diagonal.
constexpr float normal_part = 0.02f;

float normal_length_of(const MeshData& mesh) {
    return normal_part * (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm();
}

std::vector<gpu::Segment> segments_of(const MeshData& mesh, gpu::LineKind kind,
                                      std::optional<float> normal_length) {
    switch (kind) {
        case gpu::LineKind::wireframe:
            return gpu::wireframe_segments(mesh);
        case gpu::LineKind::normals:
            return gpu::normal_segments(mesh, normal_length ? *normal_length : normal_length_of(mesh));
        default:
            return gpu::edge_segments(mesh);
    }
}

LineBuffers make_line_buffers(const std::vector<gpu::Segment>& segments) {
    LineBuffers buffers;
    buffers.count = int(segments.size());
    if (segments.empty()) return buffers;
    buffers.segments = upload(segments);
    gl::VertexArray& array = buffers.array = gl::VertexArray::make();
    const auto attribute = [&](unsigned location, int components, gl::AttributeType type, size_t offset) {
        array.attribute(location, buffers.segments, components, type, sizeof(gpu::Segment), int(offset), 1);
    };
    attribute(0, 3, gl::AttributeType::f32, offsetof(gpu::Segment, a));
    attribute(1, 4, gl::AttributeType::unorm8, offsetof(gpu::Segment, color_a));
    attribute(2, 3, gl::AttributeType::f32, offsetof(gpu::Segment, b));
    attribute(3, 4, gl::AttributeType::unorm8, offsetof(gpu::Segment, color_b));
    attribute(4, 3, gl::AttributeType::f32, offsetof(gpu::Segment, places));
    return buffers;
}

}  // namespace

LineCache::Key LineCache::key_of(const MeshData& mesh, gpu::LineKind kind,
                                 std::optional<float> normal_length) {
    return {{mesh.V.revision(), mesh.E.revision(), mesh.F.revision(), mesh.N.revision(), mesh.C.revision(),
             mesh.UV.revision(), mesh.source_vertex.revision(), mesh.source_face.revision()},
            kind,
            normal_length};
}

const LineBuffers& LineCache::get(const MeshData& mesh, gpu::LineKind kind,
                                  std::optional<float> normal_length) {
    return buffers_.get(key_of(mesh, kind, normal_length),
                        [&] { return make_line_buffers(segments_of(mesh, kind, normal_length)); });
}

const std::vector<gpu::Segment>& LineCache::segments(const MeshData& mesh, gpu::LineKind kind,
                                                     std::optional<float> normal_length) {
    return segments_.get(key_of(mesh, kind, normal_length),
                         [&] { return segments_of(mesh, kind, normal_length); });
}

}  // namespace easypbr::render
