#include "easypbr/geometry/voxels.h"

#include <limits>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/require.h"

namespace easypbr {
namespace {

void require_grid(const VoxelGrid& grid, size_t values) {
    geometry::require_positive("voxels: cell size", grid.cell_size);
    if (!grid.origin.allFinite()) throw ArgumentError("voxels: expected a finite origin");
    size_t cells = 1;
    for (const int count : grid.cells) {
        geometry::require_between("voxels: cells along an axis", count, 0, std::numeric_limits<int>::max());
        cells *= size_t(count);
    }
    if (cells != values)
        throw ArgumentError(fmt::format("voxels: expected {} values for {} x {} x {} cells, got {}", cells,
                                        grid.cells[0], grid.cells[1], grid.cells[2], values));
}

/// Places of the values for which is_occupied(place).
template <class IsOccupied>
std::vector<size_t> occupied_places(size_t count, IsOccupied&& is_occupied) {
    std::vector<size_t> places;
    for (size_t place = 0; place < count; ++place)
        if (is_occupied(place)) places.push_back(place);
    if (places.size() > size_t(std::numeric_limits<int32_t>::max()))
        throw ArgumentError(fmt::format("voxels: expected at most {} occupied cells, got {}",
                                        std::numeric_limits<int32_t>::max(), places.size()));
    return places;
}

MeshData centers(const VoxelGrid& grid, const std::vector<size_t>& places) {
    const auto ny = size_t(grid.cells[1]), nz = size_t(grid.cells[2]);
    Array3f::Dense V(Eigen::Index(places.size()), 3);
    parallel_for(places.size(), size_t(1) << 15, [&](size_t row) {
        const size_t place = places[row];
        const size_t x = place / nz / ny, y = place / nz % ny, z = place % nz;
        const Vec3d cell{double(x), double(y), double(z)};
        V.row(Eigen::Index(row)) =
            (grid.origin + grid.cell_size * (cell.array() + 0.5).matrix()).cast<float>().transpose();
    });
    MeshData data;
    data.name = "voxels";
    data.V = std::move(V);
    data.voxel_size = float(grid.cell_size);
    return data;
}

}  // namespace

Mesh make_voxels(const VoxelGrid& grid, std::span<const uint8_t> occupied) {
    require_grid(grid, occupied.size());
    return Mesh(centers(grid, occupied_places(occupied.size(), [&](size_t i) { return occupied[i] != 0; })));
}

Mesh make_voxels(const VoxelGrid& grid, std::span<const int32_t> labels, int32_t empty) {
    require_grid(grid, labels.size());
    const auto places = occupied_places(labels.size(), [&](size_t i) { return labels[i] != empty; });
    MeshData data = centers(grid, places);
    Array1i::Dense L(Eigen::Index(places.size()));
    for (size_t row = 0; row < places.size(); ++row) L[Eigen::Index(row)] = labels[places[row]];
    data.L = std::move(L);
    return Mesh(std::move(data));
}

Mesh make_voxels(const VoxelGrid& grid, const ArrayXf& colors) {
    if (!colors.empty() && colors.cols() != 3 && colors.cols() != 4)
        throw ArgumentError(
            fmt::format("voxels: expected colours of 3 or 4 channels, got {}", colors.cols()));
    require_grid(grid, size_t(colors.rows()));
    const auto places = occupied_places(size_t(colors.rows()), [&](size_t i) {
        const auto color = colors.row(Eigen::Index(i));
        return color.allFinite() && (color.cols() == 3 || color[3] > 0);
    });
    MeshData data = centers(grid, places);
    ArrayXf::Dense C(Eigen::Index(places.size()), colors.cols());
    for (size_t row = 0; row < places.size(); ++row)
        C.row(Eigen::Index(row)) = colors.row(Eigen::Index(places[row]));
    data.C = std::move(C);
    return Mesh(std::move(data));
}

}  // namespace easypbr
