#include "easypbr/gpu/surfel_buffers.h"

#include <array>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/packing.h"

namespace easypbr::gpu {
namespace {

constexpr size_t surfel_grain = 1 << 15;
/// As in shaders/geometry_surfels.vert.
enum Location { position_at, normal_at, color_at, axes_at };

template <class To, class Convert>
gl::Buffer converted(Eigen::Index count, Convert&& convert) {
    std::vector<To> values(static_cast<size_t>(count));
    parallel_for(values.size(), surfel_grain, [&](size_t i) { values[i] = convert(Eigen::Index(i)); });
    return upload(values);
}

SurfelBuffers make_buffers(const MeshData& mesh) {
    SurfelBuffers buffers;
    buffers.positions = gl::Buffer(std::as_bytes(std::span(mesh.V.data(), size_t(mesh.V.size()))));
    buffers.normals = gl::Buffer(std::as_bytes(std::span(mesh.N.data(), size_t(mesh.N.size()))));
    buffers.axes = converted<std::array<float, 4>>(mesh.V.rows(), [&](Eigen::Index i) {
        if (mesh.T.empty()) return std::array<float, 4>{};
        const Vec3 t = mesh.T.row(i);
        return std::array<float, 4>{t.x(), t.y(), t.z(), mesh.B.empty() ? t.norm() : mesh.B(i)};
    });
    gl::VertexArray& array = buffers.array = gl::VertexArray::make();
    array.attribute(position_at, buffers.positions, 3, gl::AttributeType::f32, 12, 0, 1);
    array.attribute(normal_at, buffers.normals, 3, gl::AttributeType::f32, 12, 0, 1);
    array.attribute(axes_at, buffers.axes, 4, gl::AttributeType::f32, 16, 0, 1);
    if (mesh.C.empty()) return buffers;
    buffers.colors = converted<Rgba8>(mesh.C.rows(), [&](Eigen::Index i) { return rgba8(mesh.C, i); });
    array.attribute(color_at, buffers.colors, 4, gl::AttributeType::unorm8, 4, 0, 1);
    return buffers;
}

}  // namespace

const SurfelBuffers& SurfelCache::get(const MeshData& mesh) {
    Entry& entry = entries_[{mesh.V.revision(), mesh.N.revision(), mesh.T.revision(), mesh.B.revision(),
                             mesh.C.revision()}];
    entry.used = true;
    if (!entry.buffers) entry.buffers = std::make_unique<SurfelBuffers>(make_buffers(mesh));
    return *entry.buffers;
}

void SurfelCache::evict_unused() {
    std::erase_if(entries_, [](const auto& item) { return !item.second.used; });
    for (auto& [key, entry] : entries_) entry.used = false;
}

}  // namespace easypbr::gpu
