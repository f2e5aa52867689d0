// Surfaces on which a field has one value.
#pragma once

#include <cstdint>
#include <span>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// Places of samples: corner + step (x, y, z) for whole numbers from 0 to below `size`.
struct SampleGrid {
    Eigen::Vector3i size{0, 0, 0};
    Vec3d corner{0, 0, 0};
    double step = 1;

    size_t count() const { return size_t(size.x()) * size_t(size.y()) * size_t(size.z()); }
    size_t index(int x, int y, int z) const {
        return (size_t(z) * size_t(size.y()) + size_t(y)) * size_t(size.x()) + size_t(x);
    }
};

/// A triangle mesh and, for each vertex, the edge of the grid that it lies on.
struct Isosurface {
    Array3f V;  ///< in the frame of the grid
    Array3i F;  ///< outwards, towards lower values
    struct Edge {
        size_t inside, outside;  ///< samples at or above the level, and below it
        float part;              ///< from the former to the latter
    };
    std::vector<Edge> edges;
};

/// The surface that separates samples at or above the level from those below, by marching tetrahedra: each
/// cell is cut into six tetrahedra around its diagonal, as its neighbours are (Freudenthal 1942), and the
/// surface cuts their edges where the field that is linear along them has the level. So the mesh is a
/// manifold, and closed where the samples at the grid's border are below the level. `values` are of
/// grid.count() samples, x fastest; those that are not finite count as below. In parallel; does not depend on
/// the number of threads. Throws ArgumentError for a grid of fewer than two samples a side, a number of
/// values that is not the grid's, a step that is not above 0, and when there are more vertices than an index
/// holds.
Isosurface isosurface(std::span<const float> values, const SampleGrid& grid, float level);

}  // namespace easypbr
