#include "easypbr/gpu/point_buffers.h"

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/mesh_buffers.h"
#include "easypbr/gpu/packing.h"

namespace easypbr::gpu {
namespace {

constexpr size_t point_grain = 1 << 15;

template <class To, class Convert>
gl::Buffer converted(Eigen::Index count, Convert&& convert) {
    std::vector<To> values(static_cast<size_t>(count));
    parallel_for(values.size(), point_grain, [&](size_t i) { values[i] = convert(Eigen::Index(i)); });
    return upload(values);
}

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
    Entry& entry = entries_[{mesh.V.revision(), mesh.N.revision(), mesh.C.revision()}];
    entry.used = true;
    if (!entry.buffers) entry.buffers = std::make_unique<PointBuffers>(make_buffers(mesh));
    return *entry.buffers;
}

void PointCache::evict_unused() {
    std::erase_if(entries_, [](const auto& item) { return !item.second.used; });
    for (auto& [key, entry] : entries_) entry.used = false;
}

}  // namespace easypbr::gpu
