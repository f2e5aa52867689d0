#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normals.h"

namespace easypbr {

namespace {

using VertexKey = std::array<uint32_t, 8>;

/// Bits of position, normal and uv; -0 becomes +0 so that equal numbers have equal bits.
VertexKey key_of(const Array3f& V, const Array3f& N, const Array2f& UV, Eigen::Index v) {
    const std::array<float, 8> values{V(v, 0), V(v, 1), V(v, 2),  N(v, 0),
                                      N(v, 1), N(v, 2), UV(v, 0), UV(v, 1)};
    VertexKey key;
    for (size_t i = 0; i < key.size(); ++i) key[i] = std::bit_cast<uint32_t>(values[i] + 0.0f);
    return key;
}

size_t vertex_hash(const VertexKey& key) {
    uint64_t hash = 0;
    for (const uint32_t bits : key) {
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

/// For each vertex the first one with equal position, normal and uv.
std::vector<int32_t> weld(const Array3f& V, const Array3f& N, const Array2f& UV) {
    const size_t mask = std::bit_ceil(size_t(V.rows()) * 2 + 2) - 1;
    std::vector<int32_t> slots(mask + 1, -1), first(size_t(V.rows()));
    for (size_t v = 0; v < first.size(); ++v) {
        const VertexKey key = key_of(V, N, UV, Eigen::Index(v));
        size_t slot = vertex_hash(key) & mask;
        while (slots[slot] >= 0 && key_of(V, N, UV, slots[slot]) != key) slot = (slot + 1) & mask;
        if (slots[slot] < 0) slots[slot] = int32_t(v);
        first[v] = slots[slot];
    }
    return first;
}

/// The corners (3 * face + k) around each welded vertex, in the order of the faces.
struct Fans {
    std::vector<uint32_t> begin, corners;

    Fans(const std::vector<int32_t>& first, const Array3i& F)
        : begin(first.size() + 1), corners(size_t(F.size())) {
        for (Eigen::Index c = 0; c < F.size(); ++c) ++begin[size_t(first[F.data()[c]]) + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<uint32_t> next(begin.begin(), begin.end() - 1);
        for (Eigen::Index c = 0; c < F.size(); ++c) corners[next[size_t(first[F.data()[c]])]++] = uint32_t(c);
    }
};

Vec3d any_perpendicular(const Vec3d& normal) {
    if (!normal.allFinite() || normal.isZero(0)) return Vec3d::UnitX();
    return normal.unitOrthogonal();
}

Vec3d in_plane(const Vec3d& vector, const Vec3d& normal) {
    return (vector - normal * normal.dot(vector)).normalized();
}

/// One vertex's corners, put into groups that share a tangent.
class Fan {
  public:
    Fan(const Array3f& V, const Array3f& N, const Array2f& UV, const Array3i& F,
        const std::vector<int32_t>& first)
        : V_(V), N_(N), UV_(UV), F_(F), first_(first) {}

    /// Writes the tangents of these corners, all of the same welded vertex.
    void solve(const uint32_t* corners, size_t count, ArrayXf::Dense& T) {
        corners_ = corners;
        read(count);
        unite_across_edges();
        sum_groups();
        for (size_t i = 0; i < count; ++i) T.row(corners[i]) = tangent(i);
    }

  private:
    struct Corner {
        int orientation;  ///< sign of the face's uv area; 0: it has none
        uint32_t group;   ///< index of another corner of the group, or itself
        Vec3d sum;        ///< of the group's weighted tangents, at its root
    };

    /// A face's edge at the vertex, by the vertex at its other end.
    struct Edge {
        int32_t other;
        int orientation;
        uint32_t corner;
        bool operator<(const Edge& edge) const {
            return std::tie(other, orientation, corner) < std::tie(edge.other, edge.orientation, edge.corner);
        }
    };

    int32_t vertex(uint32_t corner, int step) const {
        return F_.data()[corner - corner % 3 + (corner + uint32_t(step)) % 3];
    }
    Vec3d position(int32_t v) const { return V_.row(v).transpose().cast<double>(); }

    void read(size_t count) {
        normal_ = N_.row(vertex(corners_[0], 0)).transpose().cast<double>().normalized();
        fan_.resize(count);
        for (size_t i = 0; i < count; ++i) read_corner(uint32_t(i));
    }

    void read_corner(uint32_t i) {
        const int32_t a = vertex(corners_[i], 0), b = vertex(corners_[i], 1), c = vertex(corners_[i], 2);
        const Vec3d to_b = position(b) - position(a), to_c = position(c) - position(a);
        const Eigen::Vector2d uv_b = (UV_.row(b).cast<double>() - UV_.row(a).cast<double>()).transpose();
        const Eigen::Vector2d uv_c = (UV_.row(c).cast<double>() - UV_.row(a).cast<double>()).transpose();
        const double uv_area = uv_b.x() * uv_c.y() - uv_b.y() * uv_c.x();
        const int orientation = uv_area > 0 ? 1 : uv_area < 0 ? -1 : 0;
        const Vec3d gradient = orientation * (uv_c.y() * to_b - uv_b.y() * to_c);
        const double cosine = in_plane(to_b, normal_).dot(in_plane(to_c, normal_));
        const Vec3d weighted = std::acos(std::clamp(cosine, -1.0, 1.0)) * in_plane(gradient, normal_);
        const bool valid = orientation != 0 && weighted.allFinite() && !gradient.isZero(0);
        fan_[i] = {valid ? orientation : 0, i, valid ? weighted : Vec3d(Vec3d::Zero())};
    }

    uint32_t root(uint32_t i) {
        while (fan_[i].group != i) i = fan_[i].group = fan_[fan_[i].group].group;
        return i;
    }

    void unite_across_edges() {
        edges_.clear();
        for (uint32_t i = 0; i < fan_.size(); ++i)
            for (const int step : {1, 2})
                edges_.push_back({first_[size_t(vertex(corners_[i], step))], fan_[i].orientation, i});
        std::sort(edges_.begin(), edges_.end());
        for (size_t e = 1; e < edges_.size(); ++e) {
            const Edge &one = edges_[e - 1], &two = edges_[e];
            if (one.other != two.other || one.orientation != two.orientation) continue;
            const uint32_t a = root(one.corner), b = root(two.corner);
            fan_[std::max(a, b)].group = std::min(a, b);
        }
    }

    void sum_groups() {
        donor_ = fan_.size();
        for (uint32_t i = 0; i < fan_.size(); ++i) {
            if (fan_[i].orientation == 0) continue;
            donor_ = std::min(donor_, size_t(i));
            const uint32_t to = root(i);
            if (to != i) fan_[to].sum += fan_[i].sum;
        }
    }

    /// A face without uv area takes over what another face of the vertex has.
    Eigen::RowVector4f tangent(size_t i) {
        const size_t from = fan_[i].orientation != 0 ? i : donor_;
        if (from == fan_.size()) return row(any_perpendicular(normal_), 1);
        const Vec3d sum = fan_[root(uint32_t(from))].sum;
        const bool cancelled = sum.norm() < 1e-12;
        return row(cancelled ? any_perpendicular(normal_) : Vec3d(sum.normalized()), fan_[from].orientation);
    }

    static Eigen::RowVector4f row(const Vec3d& tangent, int sign) {
        const Vec3 t = tangent.cast<float>();
        return {t.x(), t.y(), t.z(), float(sign)};
    }

    const Array3f& V_;
    const Array3f& N_;
    const Array2f& UV_;
    const Array3i& F_;
    const std::vector<int32_t>& first_;
    const uint32_t* corners_ = nullptr;
    Vec3d normal_ = Vec3d::UnitZ();
    std::vector<Corner> fan_;
    std::vector<Edge> edges_;
    size_t donor_ = 0;  ///< the first corner with a tangent of its own
};

}  // namespace

ArrayXf corner_tangents(const Array3f& V, const Array3f& N, const Array2f& UV, const Array3i& F) {
    if (N.rows() != V.rows() || UV.rows() != V.rows())
        throw ArgumentError(fmt::format(
            "tangents: expected a normal and a uv for each of {} vertices, got {} normals and {} uv",
            V.rows(), N.rows(), UV.rows()));
    require_faces(F, V.rows());
    const std::vector<int32_t> first = weld(V, N, UV);
    const Fans fans(first, F);
    ArrayXf::Dense T(F.size(), 4);
    parallel_chunks(first.size(), 4096, [&](size_t begin, size_t end) {
        Fan fan(V, N, UV, F, first);
        for (size_t v = begin; v < end; ++v)
            if (const size_t count = fans.begin[v + 1] - fans.begin[v])
                fan.solve(fans.corners.data() + fans.begin[v], count, T);
    });
    return T;
}

namespace {

/// Mixtures of vertices with different signs have no tangent.
bool is_tangent(const Array4f& tangents, Eigen::Index vertex) {
    return std::abs(tangents(vertex, 3)) > 0.5f;
}

}  // namespace

bool has_all_tangents(const MeshData& mesh) {
    const Array4f& given = mesh.uv_tangents;
    for (Eigen::Index i = 0; i < given.rows(); ++i)
        if (!is_tangent(given, i)) return false;
    return !given.empty();
}

ArrayXf mesh_tangents(const MeshData& mesh, const Array3f& N) {
    const Array4f& given = mesh.uv_tangents;
    const auto computed = [&] { return corner_tangents(mesh.V, N, mesh.UV, mesh.F); };
    if (given.empty()) return computed();
    const auto is_given = [&](Eigen::Index vertex) { return is_tangent(given, vertex); };
    require_faces(mesh.F, given.rows());
    const std::span<const int32_t> corners(mesh.F.data(), size_t(mesh.F.size()));
    ArrayXf::Dense T = std::ranges::all_of(corners, is_given) ? ArrayXf::Dense(mesh.F.size(), 4)
                                                              : ArrayXf::Dense(computed());
    parallel_for(corners.size(), 1 << 15, [&](size_t i) {
        if (is_given(corners[i])) T.row(Eigen::Index(i)) = given.row(corners[i]);
    });
    return T;
}

}  // namespace easypbr
