#include "easypbr/geometry/isosurface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/require.h"

namespace easypbr {
namespace {

/// Vertices stay this part of an edge off its ends, so that no triangle collapses.
constexpr float least_part = 1e-4f;

/// Corners of a cell, and directions of edges: bits of x, y, z.
using Corner = unsigned;
/// Of positive volume: the product of the edges from the first corner to the second, third and fourth.
using Tetrahedron = std::array<Corner, 4>;

/// One for each order of the axes in which ways from corner 0 to corner 7 go.
constexpr std::array<Tetrahedron, 6> tetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 1, 7, 5}, {0, 2, 7, 3}, {0, 4, 7, 6}}};
/// Even orders of four that begin with each of them, and with each pair of them.
constexpr std::array<std::array<int, 4>, 4> from_one = {
    {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
constexpr std::array<std::array<int, 4>, 6> from_two = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

class Marching {
  public:
    Marching(std::span<const float> values, const SampleGrid& grid, float level)
        : values_(values), grid_(grid), level_(level), cuts_(grid.count()), first_(grid.count()) {}

    Isosurface run() {
        find_cuts();
        Isosurface surface;
        place_vertices(surface);
        surface.F = faces();
        return surface;
    }

  private:
    bool is_inside(size_t sample) const { return values_[sample] >= level_; }
    size_t corner_of(size_t sample, Corner corner) const {
        const size_t row = size_t(grid_.size.x()), slice = row * size_t(grid_.size.y());
        return sample + (corner & 1) + (corner >> 1 & 1) * row + (corner >> 2) * slice;
    }
    /// Calls body(x, y, z, sample) for a slice.
    template <class Body>
    void for_slice(int z, Body&& body) const {
        for (int y = 0; y < grid_.size.y(); ++y)
            for (int x = 0; x < grid_.size.x(); ++x) body(x, y, grid_.index(x, y, z));
    }

    /// Which of a sample's edges in the seven directions the surface cuts, and how many before.
    void find_cuts() {
        const Eigen::Vector3i& n = grid_.size;
        std::vector<size_t> in_slice(size_t(n.z()) + 1);
        parallel_for(size_t(n.z()), 1, [&](size_t z) {
            size_t count = 0;
            for_slice(int(z), [&](int x, int y, size_t sample) {
                const bool inside = is_inside(sample);
                const Corner ends =
                    (x + 1 < n.x() ? 1u : 0u) | (y + 1 < n.y() ? 2u : 0u) | (int(z) + 1 < n.z() ? 4u : 0u);
                unsigned cut = 0;
                for (Corner way = 1; way < 8; ++way)
                    if ((way & ~ends) == 0 && is_inside(corner_of(sample, way)) != inside) cut |= 1u << way;
                cuts_[sample] = uint8_t(cut);
                first_[sample] = uint32_t(count);
                count += size_t(std::popcount(cut));
            });
            in_slice[z + 1] = count;
        });
        for (size_t z = 0; z < size_t(n.z()); ++z) in_slice[z + 1] += in_slice[z];
        count_ = in_slice.back();
        if (count_ > size_t(std::numeric_limits<int32_t>::max()))
            throw ArgumentError(
                fmt::format("isosurface: expected at most 2^31 - 1 vertices, got {}", count_));
        parallel_for(size_t(n.z()), 1, [&](size_t z) {
            for_slice(int(z), [&](int, int, size_t sample) { first_[sample] += uint32_t(in_slice[z]); });
        });
    }

    void place_vertices(Isosurface& surface) const {
        Array3f::Dense V(Eigen::Index(count_), 3);
        surface.edges.resize(count_);
        parallel_for(size_t(grid_.size.z()), 1, [&](size_t z) {
            for_slice(int(z), [&](int x, int y, size_t sample) {
                size_t vertex = first_[sample];
                for (Corner way = 1; way < 8; ++way) {
                    if (!(cuts_[sample] >> way & 1)) continue;
                    const size_t other = corner_of(sample, way);
                    const double at = crossing(sample, other);
                    const Vec3d from(x, y, double(z)), along(way & 1, way >> 1 & 1, way >> 2);
                    V.row(Eigen::Index(vertex)) =
                        (grid_.corner + grid_.step * (from + at * along)).cast<float>().transpose();
                    surface.edges[vertex++] = is_inside(sample)
                                                  ? Isosurface::Edge{sample, other, float(at)}
                                                  : Isosurface::Edge{other, sample, float(1 - at)};
                }
            });
        });
        surface.V = std::move(V);
    }

    double crossing(size_t a, size_t b) const {
        const auto finite = [&](size_t i) {
            return std::isfinite(values_[i]) ? double(values_[i]) : double(level_) - 1;
        };
        const double from = finite(a), to = finite(b);
        return std::clamp((double(level_) - from) / (to - from), double(least_part), double(1 - least_part));
    }

    int32_t vertex(size_t sample, Corner a, Corner b) const {
        const Corner low = std::min(a, b), way = low ^ std::max(a, b);
        const size_t base = corner_of(sample, low);
        const unsigned before = cuts_[base] & ((1u << way) - 1);
        return int32_t(first_[base]) + std::popcount(before);
    }

    Array3i faces() const {
        const int slices = grid_.size.z() - 1;
        std::vector<std::vector<Eigen::Vector3i>> found{size_t(slices)};
        parallel_for(size_t(slices), 1, [&](size_t z) {
            for_slice(int(z), [&](int x, int y, size_t sample) {
                if (x + 1 < grid_.size.x() && y + 1 < grid_.size.y()) add_cell(sample, found[z]);
            });
        });
        size_t count = 0;
        for (const auto& slice : found) count += slice.size();
        Array3i::Dense F(Eigen::Index(count), 3);
        Eigen::Index row = 0;
        for (const auto& slice : found)
            for (const Eigen::Vector3i& face : slice) F.row(row++) = face.transpose();
        return F;
    }

    void add_cell(size_t sample, std::vector<Eigen::Vector3i>& to) const {
        unsigned inside = 0;
        for (Corner corner = 0; corner < 8; ++corner)
            inside |= unsigned(is_inside(corner_of(sample, corner))) << corner;
        if (inside == 0 || inside == 255) return;
        for (const Tetrahedron& one : tetrahedra) add_tetrahedron(sample, one, inside, to);
    }

    void add_tetrahedron(size_t sample, const Tetrahedron& one, unsigned inside_cell,
                         std::vector<Eigen::Vector3i>& to) const {
        unsigned inside = 0;
        for (unsigned i = 0; i < 4; ++i) inside |= (inside_cell >> one[i] & 1u) << i;
        const auto cut = [&](int a, int b) { return vertex(sample, one[size_t(a)], one[size_t(b)]); };
        const int count = std::popcount(inside);
        if (count == 1 || count == 3) {
            const int apart = std::countr_zero(count == 1 ? inside : inside ^ 15u);
            const auto& [a, b, c, d] = from_one[size_t(apart)];
            if (count == 1)
                to.emplace_back(cut(a, b), cut(a, c), cut(a, d));
            else
                to.emplace_back(cut(a, b), cut(a, d), cut(a, c));
        } else if (count == 2) {
            const auto& [a, b, c, d] = *std::ranges::find_if(
                from_two, [&](const auto& order) { return inside == (1u << order[0] | 1u << order[1]); });
            const int32_t corners[4] = {cut(a, c), cut(a, d), cut(b, d), cut(b, c)};
            to.emplace_back(corners[0], corners[1], corners[2]);
            to.emplace_back(corners[0], corners[2], corners[3]);
        }
    }

    std::span<const float> values_;
    SampleGrid grid_;
    float level_;
    std::vector<uint8_t> cuts_;    ///< by direction
    std::vector<uint32_t> first_;  ///< vertex of a sample's first edge that is cut
    size_t count_ = 0;
};

}  // namespace

Isosurface isosurface(std::span<const float> values, const SampleGrid& grid, float level) {
    if (grid.size.minCoeff() < 2)
        throw ArgumentError(fmt::format("isosurface: expected at least 2 samples a side, got {} x {} x {}",
                                        grid.size.x(), grid.size.y(), grid.size.z()));
    if (values.size() != grid.count())
        throw ArgumentError(
            fmt::format("isosurface: expected {} values, one a sample, got {}", grid.count(), values.size()));
    geometry::require_positive("isosurface: step", grid.step);
    return Marching(values, grid, level).run();
}

}  // namespace easypbr
