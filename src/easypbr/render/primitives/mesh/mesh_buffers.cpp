#include "easypbr/render/primitives/mesh/mesh_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/facing.h"
#include "easypbr/gpu/packing.h"
#include "easypbr/scene/normals.h"

namespace easypbr::render {
namespace {

constexpr size_t corner_grain = 1 << 15;

struct Tangent16 {
    int16_t x, y, z, w;
    bool operator==(const Tangent16&) const = default;
};

/// Vertices of the file, some of them doubled because their corners have different tangents.
struct SplitMesh {
    std::vector<int32_t> vertex;  ///< the file's vertex of each new one
    std::vector<Tangent16> tangents;
    std::vector<int32_t> indices;
};

SplitMesh split_by_tangent(const MeshData& mesh, const Array3f& N) {
    const Array3i& F = mesh.F;
    const ArrayXf corners = mesh_tangents(mesh, N);
    SplitMesh split;
    const size_t n = size_t(mesh.V.rows());
    split.vertex.resize(n);
    split.tangents.assign(n, Tangent16{0, 0, 0, 0});
    split.indices.resize(size_t(F.size()));
    std::vector<int32_t> next(n, -1);  // chains the doubles of a vertex
    std::vector<bool> taken(n, false);
    for (size_t i = 0; i < n; ++i) split.vertex[i] = int32_t(i);
    for (size_t c = 0; c < split.indices.size(); ++c) {
        const float* t = corners.data() + 4 * c;
        const Tangent16 tangent{gpu::snorm16(t[0]), gpu::snorm16(t[1]), gpu::snorm16(t[2]),
                                gpu::snorm16(t[3])};
        size_t v = size_t(F.data()[c]);
        if (!taken[v]) {
            taken[v] = true;
            split.tangents[v] = tangent;
        }
        while (split.tangents[v] != tangent && next[v] >= 0) v = size_t(next[v]);
        if (split.tangents[v] != tangent) {
            next[v] = int32_t(split.vertex.size());
            v = split.vertex.size();
            split.vertex.push_back(F.data()[c]);
            split.tangents.push_back(tangent);
            next.push_back(-1);
        }
        split.indices[c] = int32_t(v);
    }
    return split;
}

/// Rows of an array in the order of `vertex` (all of them in file order when it is empty) as values of type
/// To.
template <class To, class ArrayType, class Convert>
gl::Buffer gather(const ArrayType& array, const std::vector<int32_t>& vertex, Convert&& convert) {
    std::vector<To> values(vertex.empty() ? size_t(array.rows()) : vertex.size());
    parallel_for(values.size(), corner_grain,
                 [&](size_t i) { values[i] = convert(vertex.empty() ? Eigen::Index(i) : vertex[i]); });
    return gpu::upload(values);
}

void describe(MeshBuffers& buffers) {
    gl::VertexArray& array = buffers.array = gl::VertexArray::make();
    array.attribute(position_location, buffers.positions, 3, gl::AttributeType::f32, 12);
    array.attribute(normal_location, buffers.normals, 2, gl::AttributeType::snorm16, 4);
    if (buffers.colors) array.attribute(color_location, buffers.colors, 4, gl::AttributeType::unorm8, 4);
    if (buffers.uvs) array.attribute(uv_location, buffers.uvs, 2, gl::AttributeType::f32, 8);
    if (buffers.tangents)
        array.attribute(tangent_location, buffers.tangents, 4, gl::AttributeType::snorm16, 8);
    array.indices(buffers.indices);
}

MeshBuffers make_mesh_buffers(const MeshData& mesh, bool with_tangents) {
    MeshBuffers buffers;
    const Array3f N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
    buffers.normals_agree = mesh.N.empty() || gpu::normals_agree_with_winding(mesh.V, N, mesh.F);
    buffers.winding = gpu::winding_of(mesh.V, mesh.F);
    if (buffers.winding == gpu::Winding::outward) buffers.box = gpu::box_of(mesh.V);
    SplitMesh split;
    if (with_tangents) {
        split = split_by_tangent(mesh, N);
        buffers.tangents = gpu::upload(split.tangents);
        buffers.indices = gpu::upload(split.indices);
    } else {
        buffers.indices = gl::Buffer(std::as_bytes(std::span(mesh.F.data(), size_t(mesh.F.size()))));
    }
    if (with_tangents)
        buffers.positions = gather<std::array<float, 3>>(mesh.V, split.vertex, [&](Eigen::Index i) {
            return std::array<float, 3>{mesh.V(i, 0), mesh.V(i, 1), mesh.V(i, 2)};
        });
    else
        buffers.positions = gl::Buffer(std::as_bytes(std::span(mesh.V.data(), size_t(mesh.V.size()))));
    buffers.normals =
        gather<gpu::Oct16>(N, split.vertex, [&](Eigen::Index i) { return gpu::oct16(N.row(i).transpose()); });
    if (!mesh.C.empty())
        buffers.colors =
            gather<Rgba8>(mesh.C, split.vertex, [&](Eigen::Index i) { return gpu::rgba8(mesh.C, i); });
    if (!mesh.UV.empty())
        buffers.uvs = gather<std::array<float, 2>>(mesh.UV, split.vertex, [&](Eigen::Index i) {
            return std::array<float, 2>{mesh.UV(i, 0), mesh.UV(i, 1)};
        });
    describe(buffers);
    return buffers;
}

}  // namespace

const MeshBuffers& MeshCache::get(const MeshData& mesh, bool with_tangents) {
    const Key key{mesh.V.revision(),           mesh.N.revision(), mesh.C.revision(), mesh.UV.revision(),
                  mesh.uv_tangents.revision(), mesh.F.revision(), with_tangents};
    return buffers_.get(key, [&] { return make_mesh_buffers(mesh, with_tangents); });
}

}  // namespace easypbr::render
