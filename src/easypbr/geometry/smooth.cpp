#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/adjacency.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/remesh.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/weld.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normals.h"

namespace easypbr {
namespace {

using Positions = std::vector<Vec3d>;

/// Every inner position moved by `share` of the way to the mean of its neighbours.
Positions step(const Positions& before, const geometry::Adjacency& adjacency, double share) {
    Positions after(before.size());
    parallel_for(before.size(), 4096, [&](size_t i) {
        const auto neighbors = adjacency.of(int32_t(i));
        after[i] = before[i];
        if (neighbors.empty() || adjacency.is_border(int32_t(i))) return;
        Vec3d sum = Vec3d::Zero();
        for (const int32_t neighbor : neighbors) sum += before[size_t(neighbor)];
        after[i] += share * (sum / double(neighbors.size()) - before[i]);
    });
    return after;
}

}  // namespace

Mesh smooth(const Mesh& mesh, int iterations, Smoothing smoothing) {
    geometry::require_in("smooth: iterations", iterations, geometry::smooth_iterations);
    const auto data = mesh.snapshot();
    geometry::require_faces("smooth", *data);
    const geometry::Adjacency adjacency(*data);
    Positions positions(adjacency.count());
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i] = data->V.row(adjacency.weld().first[i]).transpose().cast<double>();
    for (int i = 0; i < iterations; ++i) {
        positions = step(positions, adjacency, 0.5);
        if (smoothing == Smoothing::taubin) positions = step(positions, adjacency, -0.53);
    }
    Array3f::Dense V(data->V.rows(), 3);
    for (Eigen::Index v = 0; v < V.rows(); ++v)
        V.row(v) = positions[size_t(adjacency.weld().place[size_t(v)])].cast<float>().transpose();
    MeshData result = *mesh.clone().snapshot();
    geometry::remember_seams(result);
    result.V = std::move(V);
    if (!result.N.empty()) result.N = smooth_normals(result);
    drop_stale_tangents(result, *data);
    return Mesh(std::move(result));
}

}  // namespace easypbr
