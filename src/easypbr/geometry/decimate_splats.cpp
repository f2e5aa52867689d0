#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/geometry/spatial_order.h"
#include "easypbr/scene/splat_basis.h"

namespace easypbr {
namespace {

constexpr size_t merge_grain = 1 << 11;
/// No union is more opaque than what is drawn (Kerbl et al. 2023).
constexpr double most_opacity = 0.99;

/// A splat that may stand for several.
struct Cluster {
    Vec3d mean;
    Mat3d covariance;
    double opacity = 0;
    Eigen::VectorXf sh;
    int32_t from = 0;  ///< the splat of which it has the other values

    /// About the area that it covers: the ellipsoid's mean over all directions of view is the mean of the
    /// products of two axes.
    double area() const {
        const Vec3d s = Eigen::SelfAdjointEigenSolver<Mat3d>(covariance, Eigen::EigenvaluesOnly)
                            .eigenvalues()
                            .cwiseMax(0.0)
                            .cwiseSqrt();
        return (s[0] * s[1] + s[1] * s[2] + s[2] * s[0]) / 3;
    }
};

std::vector<Cluster> clusters_of(const MeshData& mesh) {
    const std::vector<int32_t> order = spatial_order(mesh.V);
    std::vector<Cluster> clusters(order.size());
    const SplatArrays& splats = mesh.splats;
    parallel_for(order.size(), merge_grain, [&](size_t place) {
        const Eigen::Index i = order[place];
        const auto q = splats.rotations.row(i).cast<double>();
        const Mat3d axes = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix() *
                           splats.scales.row(i).transpose().cast<double>().asDiagonal();
        clusters[place] = {mesh.V.row(i).transpose().cast<double>(), axes * axes.transpose(),
                           double(splats.opacities(i)), splats.sh.row(i).transpose(), int32_t(i)};
    });
    return clusters;
}

/// The union of two, and what it costs.
struct Union {
    Cluster cluster;
    double cost = 0;
};

Union union_of(const Cluster& a, const Cluster& b) {
    const double covered_a = a.opacity * a.area(), covered_b = b.opacity * b.area(),
                 both = covered_a + covered_b;
    const double share = both > 0 ? covered_a / both : 0.5;
    Union out;
    Cluster& c = out.cluster;
    c.mean = share * a.mean + (1 - share) * b.mean;
    const Vec3d d = a.mean - b.mean;
    c.covariance =
        share * a.covariance + (1 - share) * b.covariance + share * (1 - share) * d * d.transpose();
    const double area = c.area();
    c.opacity = area > 0 ? std::min(both / area, most_opacity) : std::max(a.opacity, b.opacity);
    c.sh = float(share) * a.sh + float(1 - share) * b.sh;
    c.from = share >= 0.5 ? a.from : b.from;
    const Eigen::Vector3f color = splat_constant * (a.sh.head<3>() - b.sh.head<3>());
    out.cost = std::max(0.0, area - std::max(a.area(), b.area())) + both * double(color.norm());
    return out;
}

/// Merges pairs that follow each other, beginning at `first`, the cheapest ones, until `surplus` are gone or
/// all pairs are merged.
void merge_pairs(std::vector<Cluster>& clusters, size_t first, size_t surplus) {
    std::vector<Union> unions((clusters.size() - first) / 2);
    parallel_for(unions.size(), merge_grain, [&](size_t k) {
        unions[k] = union_of(clusters[first + 2 * k], clusters[first + 2 * k + 1]);
    });
    std::vector<size_t> order(unions.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return unions[a].cost < unions[b].cost; });
    // At most half of the pairs: the dear ones wait for a better partner.
    const size_t merges = std::min(surplus, (unions.size() + 1) / 2);
    std::vector<char> merges_here(unions.size(), 0);
    for (size_t k = 0; k < merges; ++k) merges_here[order[k]] = 1;
    std::vector<Cluster> out;
    out.reserve(clusters.size() - merges);
    for (size_t i = 0; i < clusters.size(); ++i) {
        const bool paired = i >= first && (i - first) / 2 < unions.size();
        const size_t pair = (i - first) / 2;
        if (!paired || !merges_here[pair])
            out.push_back(std::move(clusters[i]));
        else if ((i - first) % 2 == 0)
            out.push_back(std::move(unions[pair].cluster));
    }
    clusters.swap(out);
}

MeshData mesh_of(const MeshData& mesh, const std::vector<Cluster>& clusters) {
    std::vector<int32_t> from(clusters.size());
    std::ranges::transform(clusters, from.begin(), &Cluster::from);
    MeshData out = geometry::gather_vertices(mesh, from);
    const auto count = Eigen::Index(clusters.size());
    Array3f::Dense V(count, 3), scales(count, 3);
    Array4f::Dense rotations(count, 4);
    Array1f::Dense opacities(count);
    ArrayXf::Dense sh(count, mesh.splats.sh.cols());
    parallel_for(clusters.size(), merge_grain, [&](size_t row) {
        const auto i = Eigen::Index(row);
        const Cluster& cluster = clusters[row];
        const Eigen::SelfAdjointEigenSolver<Mat3d> solver(cluster.covariance);
        Mat3d axes = solver.eigenvectors();
        if (axes.determinant() < 0) axes.col(0) *= -1;
        const Eigen::Quaternionf q = Eigen::Quaterniond(axes).cast<float>();
        V.row(i) = cluster.mean.transpose().cast<float>();
        scales.row(i) = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().transpose().cast<float>();
        rotations.row(i) << q.w(), q.x(), q.y(), q.z();
        opacities(i) = float(cluster.opacity);
        sh.row(i) = cluster.sh.transpose();
    });
    out.V = std::move(V);
    out.splats = {std::move(scales), std::move(rotations), std::move(opacities), std::move(sh)};
    return out;
}

}  // namespace

Mesh decimate_splats(const Mesh& mesh, int64_t count) {
    const auto data = mesh.snapshot();
    geometry::require_splats("decimate_splats", *data);
    if (count < 1)
        throw ArgumentError(fmt::format("decimate_splats: expected 1 or more splats, got {}", count));
    if (data->V.rows() <= count) return mesh.clone();
    std::vector<Cluster> clusters = clusters_of(*data);
    for (size_t first = 0; clusters.size() > size_t(count); first = clusters.size() > 2 ? 1 - first : 0)
        merge_pairs(clusters, first, clusters.size() - size_t(count));
    return Mesh(mesh_of(*data, clusters));
}

}  // namespace easypbr
