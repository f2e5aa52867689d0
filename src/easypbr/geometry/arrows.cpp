// Arrows of vector fields.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/require.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/offset.h"

namespace easypbr {
namespace {

constexpr size_t arrow_grain = 512;
/// From the tip to the bottom: two of the head's side, two of its lower side, two of the shaft, one below.
constexpr int rings_of_arrow = 7;

void require_field(const Array3d& starts, const Array3d& vectors, const ArrowOptions& options) {
    const auto require_rows = [&](const char* what, Eigen::Index rows) {
        if (rows != starts.rows())
            throw ArgumentError(fmt::format("arrows: {}: expected one for each of {} starts, got {}", what,
                                            starts.rows(), rows));
    };
    require_rows("vectors", vectors.rows());
    if (!options.values.empty()) require_rows("values", options.values.rows());
    if (!options.colors.empty()) {
        require_rows("colors", options.colors.rows());
        if (options.colors.cols() != 3 && options.colors.cols() != 4)
            throw ArgumentError(
                fmt::format("arrows: colors: expected 3 or 4 channels, got {}", options.colors.cols()));
    }
    if (options.scale) geometry::require_positive("arrows: scale", *options.scale);
    if (options.radius) geometry::require_positive("arrows: radius", *options.radius);
    geometry::require_between("arrows: segments", options.segments, 3, 8192);
}

/// The rows that have an arrow: finite, and of a length above 0.
std::vector<int32_t> drawn_rows(const Array3d& starts, const Array3d& vectors, bool strict) {
    std::vector<int32_t> rows;
    Eigen::Index lost = 0, first_lost = 0;
    for (Eigen::Index i = 0; i < starts.rows(); ++i) {
        if (!starts.row(i).allFinite() || !vectors.row(i).allFinite()) {
            if (lost++ == 0) first_lost = i;
        } else if ((vectors.row(i).array() != 0).any()) {
            rows.push_back(int32_t(i));
        }
    }
    if (lost == 0) return rows;
    if (lost == starts.rows())
        throw ArgumentError(fmt::format("arrows: none of {} has a finite start and vector", lost));
    if (strict)
        throw ArgumentError(
            fmt::format("arrows: expected finite starts and vectors, got others in row {} of {}; without "
                        "strict the {} that have none are left out",
                        first_lost, starts.rows(), lost));
    log_warning(
        fmt::format("{} of {} arrows have no finite start and vector and are left out", lost, starts.rows()));
    return rows;
}

/// The median distance from a point to its nearest neighbour at another place, among those that have one
/// within their nearest eight; of many a part is asked. 0: there are no two places.
double neighbor_spacing(const Array3f& points) {
    const size_t count = std::min(size_t(points.rows()), offset_sample_count);
    Array3f::Dense queries(Eigen::Index(count), 3);
    for (size_t i = 0; i < count; ++i)
        queries.row(Eigen::Index(i)) = points.row(Eigen::Index(spread_row(i, count, size_t(points.rows()))));
    const int neighbors = int(std::min<Eigen::Index>(9, points.rows()));
    const KdTree::Nearest found = KdTree(points).nearest(queries, neighbors);
    std::vector<float> spacings;
    for (Eigen::Index i = 0; i < found.distances.rows(); ++i) {
        const auto distances = found.distances.row(i);
        const auto first = std::ranges::find_if(distances, [](float distance) { return distance > 0; });
        if (first != distances.end()) spacings.push_back(*first);
    }
    if (spacings.empty()) return 0;
    const auto middle = spacings.begin() + ptrdiff_t(spacings.size() / 2);
    std::ranges::nth_element(spacings, middle);
    return *middle;
}

double automatic_scale(const Array3f& starts, double longest) {
    const Vec3 extent = starts.colwise().maxCoeff() - starts.colwise().minCoeff();
    const double length = std::max(neighbor_spacing(starts), double(extent.norm()) / 50);
    return length > 0 ? length / longest : 1;
}

/// A ring of an arrow whose axis is y: radius, height, and the normal in the same half plane.
struct ArrowRing {
    double radius, y;
    Vec2d normal;
    int shift = 0;  ///< of the normals, in half segments
};

/// As make_arrow() has them, from the tip to the bottom.
std::array<ArrowRing, rings_of_arrow> rings_of(double length, double radius) {
    const double rim = 2.5 * radius, head = std::min(6 * radius, length / 2), neck = length - head;
    const Vec2d slope = Vec2d(head, rim).normalized(), below(0, -1), outwards(1, 0);
    return {{{0, length, slope, 1},
             {rim, neck, slope},
             {rim, neck, below},
             {radius, neck, below},
             {radius, neck, outwards},
             {radius, 0, outwards},
             {radius, 0, below}}};
}

/// The vertices of one arrow after another, written in any order.
class ArrowVertices {
  public:
    ArrowVertices(size_t arrows, int segments)
        : segments_(segments), V_(rows(arrows), 3), N_(rows(arrows), 3) {
        for (int i = 0; i < 2 * segments; ++i)
            circle_.emplace_back(std::cos(pi * i / segments), std::sin(pi * i / segments));
    }

    void set(size_t arrow, const Vec3d& start, const Vec3d& along, double length, double radius) {
        const Vec3d u = along.unitOrthogonal(), v = along.cross(u);
        const auto around = [&](int half_segments) -> Vec3d {
            const Vec2d& turn = circle_[size_t(half_segments)];
            return turn.x() * u + turn.y() * v;
        };
        Eigen::Index row = rows(arrow);
        for (const ArrowRing& ring : rings_of(length, radius))
            for (int i = 0; i < segments_; ++i, ++row) {
                const Vec3d place = start + ring.y * along + ring.radius * around(2 * i);
                const Vec3d normal = ring.normal.x() * around(2 * i + ring.shift) + ring.normal.y() * along;
                V_.row(row) = place.cast<float>().transpose();
                N_.row(row) = normal.cast<float>().transpose();
            }
    }

    void move_to(MeshData& mesh) && {
        mesh.V = std::move(V_);
        mesh.N = std::move(N_);
    }

  private:
    Eigen::Index rows(size_t arrows) const { return Eigen::Index(arrows) * rings_of_arrow * segments_; }

    int segments_;
    std::vector<Vec2d> circle_;  ///< of radius 1, in half segments
    Array3f::Dense V_, N_;
};

/// Triangles of one arrow, whose rings are numbered from its tip.
std::vector<std::array<int32_t, 3>> arrow_faces(int segments) {
    std::vector<std::array<int32_t, 3>> faces;
    const auto at = [segments](int ring, int i) { return int32_t(ring * segments + i % segments); };
    const auto add_band = [&](int lower, int upper) {
        for (int i = 0; i < segments; ++i) {
            faces.push_back({at(lower, i), at(lower, i + 1), at(upper, i + 1)});
            faces.push_back({at(lower, i), at(upper, i + 1), at(upper, i)});
        }
    };
    for (int i = 0; i < segments; ++i) faces.push_back({at(1, i), at(1, i + 1), at(0, i)});
    add_band(3, 2);
    add_band(5, 4);
    for (int i = 1; i + 1 < segments; ++i) faces.push_back({at(6, 0), at(6, i + 1), at(6, i)});
    return faces;
}

Array3i repeated(const std::vector<std::array<int32_t, 3>>& faces, size_t arrows, int segments) {
    Array3i::Dense F(Eigen::Index(faces.size() * arrows), 3);
    parallel_for(arrows, arrow_grain, [&](size_t arrow) {
        const auto shift = int32_t(arrow) * rings_of_arrow * segments;
        for (size_t i = 0; i < faces.size(); ++i)
            for (int k = 0; k < 3; ++k)
                F(Eigen::Index(arrow * faces.size() + i), k) = faces[i][size_t(k)] + shift;
    });
    return F;
}

/// Each row as often as an arrow has vertices.
template <class A>
A for_vertices(const A& array, size_t of_arrow) {
    if (array.empty()) return {};
    typename A::Dense result(array.rows() * Eigen::Index(of_arrow), array.cols());
    parallel_for(size_t(array.rows()), arrow_grain, [&](size_t arrow) {
        const auto count = Eigen::Index(of_arrow), row = Eigen::Index(arrow);
        result.middleRows(row * count, count).rowwise() = array.row(row);
    });
    return A(std::move(result));
}

}  // namespace

Mesh make_arrows(const Array3d& starts, const Array3d& vectors, const ArrowOptions& options) {
    require_field(starts, vectors, options);
    const std::vector<int32_t> rows = drawn_rows(starts, vectors, options.strict);
    MeshData mesh;
    mesh.name = "arrows";
    if (rows.empty()) return Mesh(std::move(mesh));
    const size_t of_arrow = rings_of_arrow * size_t(options.segments);
    if (rows.size() > size_t(std::numeric_limits<int32_t>::max()) / of_arrow)
        throw ArgumentError(fmt::format("arrows: expected at most {} of {} segments, got {}",
                                        size_t(std::numeric_limits<int32_t>::max()) / of_arrow,
                                        options.segments, rows.size()));
    Array3d::Dense drawn(Eigen::Index(rows.size()), 3);
    Eigen::VectorXd lengths(drawn.rows());
    for (Eigen::Index i = 0; i < drawn.rows(); ++i) {
        drawn.row(i) = starts.row(rows[size_t(i)]);
        lengths[i] = vectors.row(rows[size_t(i)]).stableNorm();
    }
    const double longest = lengths.maxCoeff();
    const LocalPositions local = local_positions(drawn);
    const double scale = options.scale ? *options.scale : automatic_scale(local.V, longest);
    ArrowVertices vertices(rows.size(), options.segments);
    parallel_for(rows.size(), arrow_grain, [&](size_t i) {
        const auto row = Eigen::Index(i);
        const double length = scale * lengths[row];
        const double radius = options.radius ? *options.radius : std::min(scale * longest / 40, length / 12);
        const Vec3d along = vectors.row(rows[i]).transpose().stableNormalized();
        vertices.set(i, drawn.row(row).transpose() - local.offset, along, length, radius);
    });
    std::move(vertices).move_to(mesh);
    mesh.offset = local.offset;
    mesh.F = repeated(arrow_faces(options.segments), rows.size(), options.segments);

    mesh.C = for_vertices(rows_of(options.colors, rows), of_arrow);
    if (!options.values.empty())
        mesh.scalars.push_back({"value", for_vertices(rows_of(options.values, rows), of_arrow)});
    mesh.scalars.push_back({"length", for_vertices(Array1f(lengths.cast<float>()), of_arrow), true});
    return Mesh(std::move(mesh));
}

}  // namespace easypbr
