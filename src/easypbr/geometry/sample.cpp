#include "easypbr/geometry/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/random.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/spatial_order.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normals.h"

namespace easypbr {
namespace {

constexpr size_t sample_grain = 4096;

/// Places on faces.
struct Samples {
    std::vector<int32_t> face;
    std::vector<Vec3d> weights;  ///< of the face's corners, barycentric
};

/// Sums of the faces' areas up to and including each.
std::vector<double> area_sums(const MeshData& mesh) {
    std::vector<double> sums(size_t(mesh.F.rows()));
    parallel_for(sums.size(), sample_grain, [&](size_t f) {
        const auto corner = [&](int k) -> Vec3d {
            return mesh.V.row(mesh.F(Eigen::Index(f), k)).transpose().cast<double>();
        };
        sums[f] = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2;
    });
    for (size_t f = 1; f < sums.size(); ++f) sums[f] += sums[f - 1];
    return sums;
}

Samples choose(const MeshData& mesh, size_t count, uint64_t seed) {
    const std::vector<double> sums = area_sums(mesh);
    if (!(sums.back() > 0)) throw ArgumentError("sample_surface: expected faces with an area, got none");
    const geometry::RandomNumbers random(seed);
    Samples samples{std::vector<int32_t>(count), std::vector<Vec3d>(count)};
    parallel_for(count, sample_grain, [&](size_t i) {
        const double at = (double(i) + random.uniform(3 * i)) / double(count) * sums.back();
        const auto found = std::upper_bound(sums.begin(), sums.end(), at);
        samples.face[i] = int32_t(std::min(found, sums.end() - 1) - sums.begin());
        // Uniform in the triangle (Osada et al. 2002, Shape Distributions, section 4.2).
        const double root = std::sqrt(random.uniform(3 * i + 1)), share = random.uniform(3 * i + 2);
        samples.weights[i] = Vec3d(1 - root, root * (1 - share), root * share);
    });
    return samples;
}

/// Rows of vertices, interpolated.
template <class A>
A interpolated(const A& array, const MeshData& mesh, const Samples& samples) {
    if (array.empty()) return {};
    typename A::Dense result(Eigen::Index(samples.face.size()), array.cols());
    parallel_for(samples.face.size(), sample_grain, [&](size_t i) {
        const auto corner = [&](int k) {
            return array.row(mesh.F(samples.face[i], k)).template cast<double>();
        };
        const Vec3d& w = samples.weights[i];
        result.row(Eigen::Index(i)) =
            (w[0] * corner(0) + w[1] * corner(1) + w[2] * corner(2)).template cast<float>();
    });
    return result;
}

Array3f sampled_normals(const MeshData& mesh, const Samples& samples) {
    const Array3f of_faces = rows_of(face_normals(mesh.V, mesh.F), samples.face);
    if (mesh.N.empty()) return of_faces;
    Array3f::Dense result = interpolated(mesh.N, mesh, samples);
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
        const float length = result.row(i).norm();
        // Opposite normals may leave nothing between them.
        result.row(i) =
            length > 1e-6f ? Eigen::RowVector3f(result.row(i) / length) : Eigen::RowVector3f(of_faces.row(i));
    }
    return result;
}

/// For each sample the corner with the largest weight.
std::vector<int32_t> nearest_corners(const MeshData& mesh, const Samples& samples) {
    std::vector<int32_t> corners(samples.face.size());
    for (size_t i = 0; i < corners.size(); ++i) {
        Eigen::Index k = 0;
        samples.weights[i].maxCoeff(&k);
        corners[i] = mesh.F(samples.face[i], k);
    }
    return corners;
}

}  // namespace

Mesh sample_surface(const Mesh& mesh, int64_t count, uint64_t seed) {
    geometry::require_in("sample_surface: count", count, geometry::sample_counts);
    const auto data = mesh.snapshot();
    geometry::require_faces("sample_surface", *data);
    const Samples samples = choose(*data, size_t(count), seed);
    MeshData points = geometry::clone_without_arrays(*data);
    points.V = interpolated(data->V, *data, samples);
    points.N = sampled_normals(*data, samples);
    points.C = interpolated(data->C, *data, samples);
    points.UV = interpolated(data->UV, *data, samples);
    points.I = interpolated(data->I, *data, samples);
    const bool labels_of_faces = element_of(*data, data->L.rows()) == PerElement::face;
    points.L = rows_of(data->L, labels_of_faces ? samples.face : nearest_corners(*data, samples));
    for (const ScalarArray& scalar : data->scalars)
        points.scalars.push_back({scalar.name, element_of(*data, scalar.values.rows()) == PerElement::face
                                                   ? rows_of(scalar.values, samples.face)
                                                   : interpolated(scalar.values, *data, samples)});
    return Mesh(std::move(points));
}

}  // namespace easypbr
