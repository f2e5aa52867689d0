#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/geometry/surfels.h"

namespace easypbr {
namespace {

constexpr size_t surfel_splat_grain = 1 << 13;

}  // namespace

Mesh surfels_from_splats(const Mesh& mesh) {
    geometry::require_splats("surfels_from_splats", *mesh.snapshot());
    const SplatArrays splats = mesh.snapshot()->splats;
    MeshData data = *cloud_from_splats(mesh).snapshot();
    const Eigen::Index count = data.V.rows();
    Array3f::Dense N(count, 3), T(count, 3);
    Array1f::Dense B(count);
    parallel_for(size_t(count), surfel_splat_grain, [&](size_t row) {
        const auto i = Eigen::Index(row);
        const auto& q = splats.rotations;
        const Mat3 axes =
            Eigen::Quaternionf(q(i, 0), q(i, 1), q(i, 2), q(i, 3)).normalized().toRotationMatrix();
        Eigen::Index shortest, longest;
        splats.scales.row(i).minCoeff(&shortest);
        splats.scales.row(i).maxCoeff(&longest);
        // Of a ball any two.
        if (longest == shortest) longest = (shortest + 1) % 3;
        const Eigen::Index other = 3 - shortest - longest;
        constexpr float as_disc = 1.41421356f;
        N.row(i) = axes.col(shortest).transpose();
        T.row(i) = axes.col(longest).transpose() * (as_disc * splats.scales(i, longest));
        B(i) = as_disc * splats.scales(i, other);
    });
    data.N = std::move(N);
    data.T = std::move(T);
    data.B = std::move(B);
    return Mesh(std::move(data));
}

}  // namespace easypbr
