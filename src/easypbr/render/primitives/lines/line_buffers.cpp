#include "easypbr/render/primitives/lines/line_buffers.h"

#include <cstddef>

namespace easypbr::render {
namespace {

std::vector<gpu::Segment> segments_of(const MeshData& mesh, gpu::LineKind kind,
                                      const gpu::NormalLines& normals) {
    switch (kind) {
        case gpu::LineKind::wireframe:
            return gpu::wireframe_segments(mesh);
        case gpu::LineKind::normals:
            return gpu::normal_segments(mesh, normals);
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
    for (const gpu::Segment& segment : segments) buffers.box.extend(Vec3(segment.a)).extend(Vec3(segment.b));
    return buffers;
}

}  // namespace

void LineBuffers::set_dashes(const std::vector<std::array<float, 2>>& dashes) {
    const auto bytes = std::as_bytes(std::span(dashes));
    if (!dashes_) {
        dashes_ = gl::Buffer(bytes.size());
        array.attribute(5, dashes_, 2, gl::AttributeType::f32, int(sizeof(dashes[0])), 0, 1);
    }
    dashes_.update(0, bytes);
}

LineCache::Key LineCache::key_of(const MeshData& mesh, gpu::LineKind kind, const gpu::NormalLines& normals) {
    return {{mesh.V.revision(), mesh.E.revision(), mesh.F.revision(), mesh.N.revision(), mesh.C.revision(),
             mesh.UV.revision(), mesh.source_vertex.revision(), mesh.source_face.revision()},
            kind,
            normals};
}

LineBuffers& LineCache::get(const MeshData& mesh, gpu::LineKind kind, const gpu::NormalLines& normals) {
    return buffers_.get(key_of(mesh, kind, normals),
                        [&] { return make_line_buffers(segments_of(mesh, kind, normals)); });
}

const std::vector<gpu::Segment>& LineCache::segments(const MeshData& mesh, gpu::LineKind kind,
                                                     const gpu::NormalLines& normals) {
    return segments_.get(key_of(mesh, kind, normals), [&] { return segments_of(mesh, kind, normals); });
}

const std::vector<gpu::ChainStep>& LineCache::chains(const MeshData& mesh) {
    return chains_.get({uint64_t(mesh.V.rows()), mesh.E.revision()}, [&] { return gpu::edge_chains(mesh); });
}

}  // namespace easypbr::render
