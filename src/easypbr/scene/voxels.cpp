#include "easypbr/scene/voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"

namespace easypbr {
namespace {

constexpr size_t voxel_grain = 1 << 14;
/// Bits of a cell's place along each axis; three fit a 64-bit key.
constexpr int axis_bits = 21;
constexpr int64_t cell_limit = int64_t(1) << (axis_bits - 1);

/// The six neighbours of a cell: steps of its key, and the corners of the side between, counter-clockwise
/// seen from outside, as bits x, y, z.
struct Side {
    int axis, step;
    int corners[4];
};
constexpr Side sides[] = {{0, -1, {0, 4, 6, 2}}, {0, 1, {1, 3, 7, 5}},  {1, -1, {0, 1, 5, 4}},
                          {1, 1, {2, 6, 7, 3}},  {2, -1, {0, 2, 3, 1}}, {2, 1, {4, 5, 7, 6}}};

int64_t key_step(int axis) {
    return int64_t(1) << (axis_bits * axis);
}

struct Cell {
    int64_t key;
    int32_t vertex;  ///< the first in the cell, once cells are merged
    bool operator<(const Cell& other) const {
        return key != other.key ? key < other.key : vertex < other.vertex;
    }
};

std::vector<Cell> cells_of(const Array3f& V, double size) {
    std::vector<Cell> cells(size_t(V.rows()));
    const Vec3d origin = V.row(0).transpose().cast<double>();
    const double reach = (V.cast<double>().rowwise() - origin.transpose()).cwiseAbs().maxCoeff() / size;
    if (!(reach < double(cell_limit - 2)))
        throw ArgumentError(
            fmt::format("voxel size {}: the vertices span {:.3g} cells, more than {} can be counted", size,
                        reach, cell_limit));
    parallel_for(cells.size(), voxel_grain, [&](size_t i) {
        int64_t key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double place = (double(V(Eigen::Index(i), axis)) - origin[axis]) / size;
            key += (int64_t(std::floor(place + 0.5)) + cell_limit) * key_step(axis);
        }
        cells[i] = {key, int32_t(i)};
    });
    std::sort(cells.begin(), cells.end());
    return cells;
}

}  // namespace

MeshData voxel_mesh(const MeshData& mesh, double size) {
    if (!(size > 0) || !std::isfinite(size))
        throw ArgumentError(fmt::format("voxel size: expected a positive number, got {}", size));
    MeshData out = mesh;
    out.N = {};
    out.C = {};
    out.UV = {};
    out.T = {};
    out.B = {};
    out.E = {};
    out.L = {};
    out.I = {};
    out.scalars.clear();
    out.parts.clear();
    out.source_vertex = {};
    out.voxel_size = 0;
    if (mesh.V.empty()) return out;

    const std::vector<Cell> vertices = cells_of(mesh.V, size);
    std::vector<Cell> cells;
    std::vector<Eigen::Vector4f> colors;
    for (size_t first = 0, last; first < vertices.size(); first = last) {
        Eigen::Vector4f sum(0, 0, 0, 0);
        for (last = first; last < vertices.size() && vertices[last].key == vertices[first].key; ++last)
            if (!mesh.C.empty()) {
                sum.head<3>() += mesh.C.row(vertices[last].vertex).head<3>().transpose();
                sum[3] += mesh.C.cols() == 4 ? mesh.C(vertices[last].vertex, 3) : 1.0f;
            }
        cells.push_back(vertices[first]);
        colors.push_back(sum / float(last - first));
    }
    const auto is_there = [&](int64_t key) {
        const auto found = std::lower_bound(cells.begin(), cells.end(), Cell{key, 0});
        return found != cells.end() && found->key == key;
    };
    std::vector<uint8_t> open(cells.size());
    parallel_for(cells.size(), voxel_grain, [&](size_t i) {
        for (int s = 0; s < 6; ++s)
            if (!is_there(cells[i].key + sides[s].step * key_step(sides[s].axis))) open[i] |= uint8_t(1 << s);
    });
    std::vector<size_t> first_side(cells.size() + 1, 0);
    for (size_t i = 0; i < cells.size(); ++i)
        first_side[i + 1] = first_side[i] + size_t(std::popcount(open[i]));
    const auto side_count = Eigen::Index(first_side.back());
    if (side_count > std::numeric_limits<int32_t>::max() / 4)
        throw ArgumentError(
            fmt::format("voxels: {} cells have too many sides to be drawn at once", cells.size()));
    Array3f::Dense V(4 * side_count, 3);
    Array3i::Dense F(2 * side_count, 3);
    ArrayXf::Dense C(mesh.C.empty() ? 0 : 4 * side_count, mesh.C.empty() ? 0 : 4);
    Array1i::Dense source(2 * side_count);
    const Vec3d origin = mesh.V.row(0).transpose().cast<double>();
    parallel_for(cells.size(), voxel_grain, [&](size_t i) {
        Vec3d low;
        for (int axis = 0; axis < 3; ++axis) {
            const int64_t place = (cells[i].key / key_step(axis)) % (int64_t(1) << axis_bits) - cell_limit;
            low[axis] = origin[axis] + (double(place) - 0.5) * size;
        }
        auto side = Eigen::Index(first_side[i]);
        for (int s = 0; s < 6; ++s) {
            if (!(open[i] >> s & 1)) continue;
            for (int k = 0; k < 4; ++k) {
                const int corner = sides[s].corners[k];
                const Vec3d p = low + size * Vec3d(corner & 1, corner >> 1 & 1, corner >> 2);
                V.row(4 * side + k) << float(p.x()), float(p.y()), float(p.z());
                if (C.rows() > 0) C.row(4 * side + k) = colors[i].transpose();
            }
            const auto a = int32_t(4 * side);
            F.row(2 * side) << a, a + 1, a + 2;
            F.row(2 * side + 1) << a, a + 2, a + 3;
            source[2 * side] = source[2 * side + 1] = cells[i].vertex;
            ++side;
        }
    });
    out.V = Array3f(std::move(V));
    out.F = Array3i(std::move(F));
    if (C.rows() > 0) out.C = ArrayXf(std::move(C));
    out.source_face = Array1i(std::move(source));
    return out;
}

}  // namespace easypbr
