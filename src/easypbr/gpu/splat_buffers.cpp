#include "easypbr/gpu/splat_buffers.h"

#include <algorithm>
#include <array>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/gpu/packing.h"
#include "easypbr/scene/splat_basis.h"

namespace easypbr::gpu {
namespace {

constexpr size_t grain = 1 << 14;

int degree_of(const MeshData& mesh, bool with_colors) {
    return with_colors ? 0 : mesh.splats.degree();
}

/// Halves of a splat's harmonics; an even number.
size_t splat_halves(int degree) {
    const size_t side = size_t(degree) + 1, values = 3 * side * side;
    return values + values % 2;
}

/// Of some of the means, by axis: single ones may lie anywhere.
Vec3 median_of(const Array3f& V) {
    const Eigen::Index step = 1 + V.rows() / 1000;
    Vec3 median;
    for (int c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (Eigen::Index i = 0; i < V.rows(); i += step) values.push_back(V(i, c));
        const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        median[c] = *middle;
    }
    return median;
}

SplatBuffers make_buffers(const MeshData& mesh, bool with_colors) {
    const SplatArrays& splats = mesh.splats;
    SplatBuffers buffers;
    const auto count = size_t(mesh.V.rows());
    buffers.count = uint32_t(count);
    buffers.degree = degree_of(mesh, with_colors);
    if (count > 0) buffers.centre = median_of(mesh.V);
    buffers.means = gl::Buffer(std::as_bytes(std::span(mesh.V.data(), 3 * count)));
    buffers.shapes = converted<std::array<float, 8>>(mesh.V.rows(), [&](Eigen::Index i) {
        const auto s = splats.scales.row(i);
        const auto q = splats.rotations.row(i);
        return std::array<float, 8>{s(0), s(1), s(2), q(0), q(1), q(2), q(3), splats.opacities(i)};
    });
    const size_t halves = splat_halves(buffers.degree);
    const Eigen::Index values = 3 * (buffers.degree + 1) * (buffers.degree + 1);
    std::vector<Eigen::half> packed(halves * count);
    parallel_for(count, grain, [&](size_t i) {
        Eigen::half* to = &packed[halves * i];
        const auto row = Eigen::Index(i);
        for (Eigen::Index k = 0; k < values; ++k)
            to[k] = Eigen::half(with_colors ? (mesh.C(row, k) - 0.5f) / splat_constant : splats.sh(row, k));
    });
    buffers.harmonics = upload(packed);
    return buffers;
}

}  // namespace

size_t largest_splat_buffer(const MeshData& mesh, bool with_colors) {
    return size_t(mesh.V.rows()) *
           std::max(8 * sizeof(float), 2 * splat_halves(degree_of(mesh, with_colors)));
}

const SplatBuffers& SplatBufferCache::get(const MeshData& mesh, bool with_colors) {
    const SplatArrays& splats = mesh.splats;
    const Key key{mesh.V.revision(), splats.scales.revision(), splats.rotations.revision(),
                  splats.opacities.revision(), with_colors ? mesh.C.revision() : splats.sh.revision()};
    return buffers_.get(key, [&] { return make_buffers(mesh, with_colors); });
}

}  // namespace easypbr::gpu
