#include "easypbr/scene/crease.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/corner_split.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normals.h"

namespace easypbr {
namespace {

constexpr size_t crease_grain = 1 << 13;

/// The corners at each vertex: those of vertex v are corners[first[v]] to corners[first[v + 1] - 1],
/// ascending.
struct VertexCorners {
    std::vector<uint32_t> first, corners;

    VertexCorners(const Array3i& F, size_t vertex_count)
        : first(vertex_count + 1, 0), corners(size_t(F.size())) {
        for (Eigen::Index c = 0; c < F.size(); ++c) ++first[size_t(F.data()[c]) + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (Eigen::Index c = 0; c < F.size(); ++c) corners[next[size_t(F.data()[c])]++] = uint32_t(c);
    }
};

/// Groups the corners at one vertex; kept between vertices for its memory.
class CornerGroups {
  public:
    CornerGroups(const Array3i& F, const Array3f& normals, const std::vector<char>& has_area,
                 float least_cosine)
        : F_(F), normals_(normals), has_area_(has_area), least_cosine_(least_cosine) {}

    /// Sets the key of each corner to the place of the first corner of its group.
    void group(std::span<const uint32_t> corners, std::vector<uint64_t>& keys) {
        parent_.resize(corners.size());
        std::iota(parent_.begin(), parent_.end(), 0);
        edges_.clear();
        for (uint32_t i = 0; i < corners.size(); ++i) {
            const uint32_t face = corners[i] / 3, k = corners[i] % 3;
            edges_.emplace_back(F_(face, (k + 1) % 3), i);
            edges_.emplace_back(F_(face, (k + 2) % 3), i);
        }
        std::sort(edges_.begin(), edges_.end());
        for (size_t e = 1; e < edges_.size(); ++e)
            if (edges_[e - 1].first == edges_[e].first) join(corners, edges_[e - 1].second, edges_[e].second);
        for (uint32_t i = 0; i < corners.size(); ++i) keys[corners[i]] = root(i);
    }

  private:
    uint32_t root(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(std::span<const uint32_t> corners, uint32_t i, uint32_t j) {
        const uint32_t a = corners[i] / 3, b = corners[j] / 3;
        const bool smooth =
            !has_area_[a] || !has_area_[b] || normals_.row(a).dot(normals_.row(b)) >= least_cosine_;
        if (!smooth) return;
        const uint32_t first = root(i), second = root(j);
        parent_[std::max(first, second)] = std::min(first, second);
    }

    const Array3i& F_;
    const Array3f& normals_;
    const std::vector<char>& has_area_;
    const float least_cosine_;
    std::vector<uint32_t> parent_;
    std::vector<std::pair<int32_t, uint32_t>> edges_;
};

std::vector<char> faces_with_area(const Array3f& V, const Array3i& F) {
    std::vector<char> has_area(size_t(F.rows()));
    parallel_for(has_area.size(), crease_grain, [&](size_t i) {
        const auto at = [&](int k) { return Vec3d(V.row(F(Eigen::Index(i), k)).transpose().cast<double>()); };
        has_area[i] = (at(1) - at(0)).cross(at(2) - at(0)).squaredNorm() > 0;
    });
    return has_area;
}

/// The faces of vertices that were split from one, which are numbered by source_vertex.
struct UnitedFaces {
    Array3i F;
    size_t vertices;

    explicit UnitedFaces(const MeshData& mesh) : F(mesh.F), vertices(size_t(mesh.V.rows())) {
        if (mesh.source_vertex.empty()) return;
        vertices = size_t(mesh.source_vertex.maxCoeff()) + 1;
        Array3i::Dense united(mesh.F.rows(), 3);
        for (Eigen::Index i = 0; i < united.size(); ++i)
            united.data()[i] = mesh.source_vertex(mesh.F.data()[i]);
        F = std::move(united);
    }
};

/// For each corner the place, among those at its vertex, of the first one that it shares a normal with.
std::vector<uint64_t> group_corners(const MeshData& mesh, const UnitedFaces& united, float crease_angle_deg) {
    // Rounding must not part faces that meet at just the given angle, above all coplanar ones at angle 0.
    constexpr double rounding = 1e-6;
    const float least_cosine =
        float(std::cos(radians(std::clamp(crease_angle_deg, 0.0f, 180.0f))) - rounding);
    const Array3f normals = face_normals(mesh.V, mesh.F);
    const std::vector<char> has_area = faces_with_area(mesh.V, mesh.F);
    const VertexCorners ring(united.F, united.vertices);
    std::vector<uint64_t> keys(size_t(united.F.size()));
    parallel_chunks(united.vertices, crease_grain, [&](size_t begin, size_t end) {
        CornerGroups groups(united.F, normals, has_area, least_cosine);
        for (size_t v = begin; v < end; ++v)
            groups.group(std::span(ring.corners).subspan(ring.first[v], ring.first[v + 1] - ring.first[v]),
                         keys);
    });
    return keys;
}

/// Normals of the vertices of F, whose corners those of `sides` are, too: of these, faces share vertices
/// where they share normals.
Array3f normals_by_side(const Array3f& V, const Array3i& F, const Array3i& sides, size_t side_count) {
    Array3f::Dense place = Array3f::Dense::Zero(Eigen::Index(side_count), 3);
    for (Eigen::Index i = 0; i < F.size(); ++i) place.row(sides.data()[i]) = V.row(F.data()[i]);
    const Array3f of_sides = vertex_normals(Array3f(std::move(place)), sides);
    Array3f::Dense N = Array3f::Dense::Zero(V.rows(), 3);
    N.col(2).setOnes();
    for (Eigen::Index i = 0; i < F.size(); ++i) N.row(F.data()[i]) = of_sides.row(sides.data()[i]);
    return Array3f(std::move(N));
}

}  // namespace

std::vector<int32_t> split_creases(MeshData& mesh, float crease_angle_deg) {
    const UnitedFaces united(mesh);
    const std::vector<uint64_t> keys = group_corners(mesh, united, crease_angle_deg);
    Array3i::Dense F = mesh.F, sides = united.F;
    CornerSplit split = split_corners({F.data(), size_t(F.size())}, keys, size_t(mesh.V.rows()));
    const CornerSplit side = split_corners({sides.data(), size_t(sides.size())}, keys, united.vertices);
    Array2i::Dense E = mesh.E;
    follow_split(split, {E.data(), size_t(E.size())});
    const FaceValues values(mesh);
    gather_vertices(split, mesh);
    mesh.F = std::move(F);
    if (!mesh.E.empty()) mesh.E = std::move(E);
    mesh.N = normals_by_side(mesh.V, mesh.F, Array3i(std::move(sides)), side.source_vertex.size());
    mesh.uv_tangents = {};
    values.put_back(mesh);
    std::vector<int32_t> rows = std::move(split.source_vertex);
    rows.resize(size_t(mesh.V.rows()), rows.empty() ? 0 : rows.back());
    return rows;
}

void split_creases(const Mesh& mesh, float crease_angle_deg) {
    const auto data = mesh.snapshot();
    if (!data->F.empty() && data->N.empty() && !data->style.flat.value_or(false))
        Mesh(mesh).edit([&](MeshData& edited) { split_creases(edited, crease_angle_deg); });
    for (const Mesh& child : data->children) split_creases(child, crease_angle_deg);
}

}  // namespace easypbr
