#include "easypbr/geometry/surfels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/adjacency.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/neighborhoods.h"
#include "easypbr/geometry/orientation.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/spatial_order.h"
#include "easypbr/geometry/surfel_cell.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normals.h"

namespace easypbr {

using geometry::Neighborhoods;

namespace {

constexpr size_t surfel_grain = 1024;

/// Normal of the plane that fits a point and its neighbours best: the direction in which they spread least.
/// Weights fall with the distance, to nearly nothing at the last neighbour, so that sharp features are kept.
Vec3 plane_normal(const Neighborhoods& neighborhoods, size_t i) {
    const Vec3d origin = neighborhoods.point(i);
    const double scale = 1 / double(neighborhoods.reach[i]);
    double weights = 1;
    Vec3d sum = Vec3d::Zero();
    Mat3d products = Mat3d::Zero();
    for (const int32_t j : neighborhoods.of(i)) {
        const Vec3d step = (neighborhoods.point(size_t(j)) - origin) * scale;
        const double closeness = 1 - step.squaredNorm() / 1.21, weight = closeness * closeness;
        weights += weight;
        sum += weight * step;
        products += weight * step * step.transpose();
    }
    const Vec3d mean = sum / weights;
    Eigen::SelfAdjointEigenSolver<Mat3d> solver;
    solver.computeDirect(products / weights - mean * mean.transpose());
    return solver.eigenvectors().col(0).cast<float>();
}

std::vector<Vec3> plane_normals(const Neighborhoods& neighborhoods, const NeighborhoodOptions& options) {
    std::vector<Vec3> normals(neighborhoods.count());
    parallel_for(normals.size(), surfel_grain,
                 [&](size_t i) { normals[i] = plane_normal(neighborhoods, i); });
    if (options.viewpoint)
        geometry::orient_towards(normals, neighborhoods, *options.viewpoint);
    else
        geometry::orient_consistently(normals, neighborhoods);
    return normals;
}

/// A given normal of length 1; (0, 0, 1) where it has no direction.
Vec3d direction_or_z(const Array3f& N, size_t i) {
    const Vec3d normal = N.row(Eigen::Index(i)).transpose().cast<double>();
    return normal.allFinite() && !normal.isZero(0) ? Vec3d(normal.stableNormalized()) : Vec3d(Vec3d::UnitZ());
}

/// The mesh's own normals for the distinct points; those of the last vertex at a place.
std::vector<Vec3> given_normals(const Array3f& N, const Neighborhoods& neighborhoods) {
    std::vector<Vec3> normals(neighborhoods.count());
    for (size_t i = 0; i < neighborhoods.place.size(); ++i)
        normals[size_t(neighborhoods.place[i])] = direction_or_z(N, i).cast<float>();
    return normals;
}

/// The viewpoint is given in the mesh's own frame, offset included; points are relative to the offset.
NeighborhoodOptions relative_to(const Vec3d& offset, NeighborhoodOptions options) {
    if (options.viewpoint) *options.viewpoint -= offset;
    return options;
}

Neighborhoods neighborhoods_of(const char* what, const MeshData& mesh, const NeighborhoodOptions& options) {
    geometry::require_vertices(what, mesh);
    if (options.viewpoint && !options.viewpoint->allFinite())
        throw ArgumentError(fmt::format("{}: expected a finite viewpoint", what));
    return geometry::find_neighborhoods(what, mesh.V, options.k);
}

/// result.row(i) = values[place[i]], in parallel.
Array3f spread(const std::vector<Vec3>& values, const std::vector<int32_t>& place) {
    Array3f::Dense result(Eigen::Index(place.size()), 3);
    parallel_for(place.size(), surfel_grain,
                 [&](size_t i) { result.row(Eigen::Index(i)) = values[size_t(place[i])].transpose(); });
    return result;
}

/// T and B of a mesh: of(i) are the axes of vertex i.
template <class Of>
void set_axes(MeshData& mesh, Of&& of) {
    Array3f::Dense T(mesh.V.rows(), 3);
    Array1f::Dense B(mesh.V.rows());
    parallel_for(size_t(mesh.V.rows()), surfel_grain, [&](size_t i) {
        const geometry::SurfelAxes axes = of(i);
        T.row(Eigen::Index(i)) = axes.first.cast<float>().transpose();
        B[Eigen::Index(i)] = float(axes.second);
    });
    mesh.T = std::move(T);
    mesh.B = std::move(B);
}

MeshData vertices_of(const MeshData& mesh) {
    std::vector<int32_t> all(static_cast<size_t>(mesh.V.rows()));
    std::iota(all.begin(), all.end(), 0);
    return geometry::gather_vertices(mesh, all);
}

}  // namespace

Mesh estimate_normals(const Mesh& mesh, const NeighborhoodOptions& options) {
    const auto data = mesh.snapshot();
    const Neighborhoods neighborhoods = neighborhoods_of("estimate_normals", *data, options);
    Mesh result = mesh.clone();
    const NeighborhoodOptions local = relative_to(data->offset, options);
    result.set_N(spread(plane_normals(neighborhoods, local), neighborhoods.place));
    return result;
}

Mesh estimate_surfels(const Mesh& mesh, const NeighborhoodOptions& options, bool keep_normals) {
    const auto data = mesh.snapshot();
    const Neighborhoods neighborhoods = neighborhoods_of("estimate_surfels", *data, options);
    const bool has_normals = keep_normals && !data->N.empty();
    const std::vector<Vec3> normals = has_normals
                                          ? given_normals(data->N, neighborhoods)
                                          : plane_normals(neighborhoods, relative_to(data->offset, options));
    std::vector<geometry::SurfelAxes> axes(neighborhoods.count());
    parallel_chunks(axes.size(), surfel_grain, [&](size_t begin, size_t end) {
        std::vector<Vec3d> steps;
        for (size_t i = begin; i < end; ++i) {
            steps.clear();
            for (const int32_t j : neighborhoods.of(i))
                steps.push_back(neighborhoods.point(size_t(j)) - neighborhoods.point(i));
            axes[i] = geometry::covering_axes(normals[i].cast<double>(), steps, neighborhoods.reach[i]);
        }
    });
    MeshData surfels = vertices_of(*data);
    surfels.N = spread(normals, neighborhoods.place);
    set_axes(surfels, [&](size_t i) { return axes[size_t(neighborhoods.place[i])]; });
    return Mesh(std::move(surfels));
}

Mesh surfels_from_mesh(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    if (!data->splats.empty()) return surfels_from_splats(mesh);
    geometry::require_faces("surfels_from_mesh", *data);
    const geometry::Adjacency adjacency(*data);
    const std::vector<int32_t>& place = adjacency.weld().place;
    std::vector<int32_t> used;
    for (size_t v = 0; v < place.size(); ++v)
        if (!adjacency.of(place[v]).empty()) used.push_back(int32_t(v));
    MeshData surfels = geometry::gather_vertices(*data, used);
    if (surfels.N.empty()) surfels.N = rows_of(smooth_normals(*data), used);
    const auto position = [&](int32_t at) -> Vec3d {
        return data->V.row(adjacency.weld().first[size_t(at)]).transpose().cast<double>();
    };
    set_axes(surfels, [&](size_t i) {
        const int32_t center = place[size_t(used[i])];
        std::vector<Vec3d> steps;
        double reach = 0;
        for (const int32_t neighbor : adjacency.of(center)) {
            steps.push_back(position(neighbor) - position(center));
            reach = std::max(reach, steps.back().norm());
        }
        return geometry::covering_axes(direction_or_z(surfels.N, i), steps, reach);
    });
    return Mesh(std::move(surfels));
}

}  // namespace easypbr
