// A mesh whose faces have no order: the clusters of a large one are of neighbours in space then.
#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// The same faces in another order.
inline MeshData shuffled(const MeshData& mesh, unsigned seed) {
    std::vector<Eigen::Index> order(size_t(mesh.F.rows()));
    std::iota(order.begin(), order.end(), Eigen::Index(0));
    std::ranges::shuffle(order, std::mt19937(seed));
    Array3i::Dense F(mesh.F.rows(), 3);
    for (size_t i = 0; i < order.size(); ++i) F.row(Eigen::Index(i)) = mesh.F.row(order[i]);
    MeshData other = mesh;
    other.F = std::move(F);
    return other;
}

}  // namespace easypbr
