#include "easypbr/scene/crease.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normal_sums.h"
#include "easypbr/scene/normals.h"

namespace easypbr {
namespace {

using detail::UnitedMesh;

constexpr size_t crease_grain = 1 << 13;

/// The face's normal; zero without an area.
Vec3d normal_of_face(const Array3f& V, const int32_t* face) {
    const auto at = [&](int k) { return Vec3d(V.row(face[k]).transpose().cast<double>()); };
    return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

/// Cosine of the largest angle that is not sharp.
double least_cosine(float crease_angle_deg) {
    // Rounding must not part faces that meet at just the given angle, above all coplanar ones at angle 0.
    constexpr double rounding = 1e-6;
    // Normals of faces that are folded onto each other have no sum.
    constexpr float most = 179.9f;
    return std::cos(radians(double(std::clamp(crease_angle_deg, 0.0f, most)))) - rounding;
}

/// For each vertex whether the normal of one of its faces deviates from the vertex normal by more than half
/// the angle. Else no two of its faces differ by more than the angle, and none is wound against the others.
std::vector<char> leaning_vertices(const UnitedMesh& mesh, double least) {
    const Array3f N = vertex_normals(mesh.V, mesh.F);
    const double least_of_half = std::sqrt((1 + least) / 2);
    std::vector<char> leaning(size_t(mesh.V.rows()), 0);
    parallel_for(size_t(mesh.F.rows()), crease_grain, [&](size_t i) {
        const int32_t* const face = mesh.F.data() + 3 * i;
        const Vec3d n = normal_of_face(mesh.V, face);
        if (n.isZero(0)) return;
        for (int k = 0; k < 3; ++k)
            if (n.dot(N.row(face[k]).transpose().cast<double>()) < least_of_half)
                std::atomic_ref(leaning[size_t(face[k])]).store(1, std::memory_order_relaxed);
    });
    return leaning;
}

/// The corners at those vertices: ordered by vertex, then by their places in F.
std::vector<KeyedIndex> corners_at(const Array3i& F, const std::vector<char>& leaning) {
    const auto count = size_t(F.size());
    std::vector<std::vector<KeyedIndex>> chunks((count + crease_grain - 1) / crease_grain);
    parallel_chunks(count, crease_grain, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            const int32_t vertex = F.data()[c];
            if (leaning[size_t(vertex)])
                chunks[begin / crease_grain].push_back({uint64_t(vertex), uint32_t(c)});
        }
    });
    std::vector<KeyedIndex> corners;
    for (const auto& chunk : chunks) corners.insert(corners.end(), chunk.begin(), chunk.end());
    parallel_sort(corners);
    return corners;
}

/// The first corner at each vertex, and the end.
std::vector<size_t> runs_of(const std::vector<KeyedIndex>& corners) {
    std::vector<size_t> first;
    for (size_t i = 0; i < corners.size(); ++i)
        if (i == 0 || corners[i].key != corners[i - 1].key) first.push_back(i);
    first.push_back(corners.size());
    return first;
}

/// Groups the corners at one vertex; kept between vertices for its memory.
class CornerGroups {
  public:
    CornerGroups(const UnitedMesh& mesh, double least) : mesh_(mesh), least_(least) {}

    /// Sets the key of each corner to twice the place of the first corner of its group, and one more where
    /// its face is wound against that one's.
    void group(std::span<const KeyedIndex> corners, std::span<uint32_t> keys) {
        parent_.resize(corners.size());
        std::iota(parent_.begin(), parent_.end(), 0);
        turned_.assign(corners.size(), 0);
        read(corners);
        for (size_t e = 1; e < edges_.size(); ++e)
            if (edges_[e - 1].to == edges_[e].to) join(edges_[e - 1], edges_[e]);
        for (uint32_t i = 0; i < corners.size(); ++i) {
            const auto [root, turned] = root_of(i);
            keys[i] = 2 * root + uint32_t(turned);
        }
    }

  private:
    /// Of a corner's face, to or from the corner's vertex.
    struct Edge {
        int32_t to;
        uint32_t corner;
        bool leaves;  ///< the face runs through it away from the vertex
        bool operator<(const Edge& other) const {
            return std::tie(to, corner, leaves) < std::tie(other.to, other.corner, other.leaves);
        }
    };
    struct Root {
        uint32_t corner;
        bool turned;
    };

    void read(std::span<const KeyedIndex> corners) {
        edges_.clear();
        normals_.clear();
        for (uint32_t i = 0; i < corners.size(); ++i) {
            const int32_t* const face = mesh_.F.data() + 3 * size_t(corners[i].index / 3);
            const uint32_t k = corners[i].index % 3;
            edges_.push_back({face[(k + 1) % 3], i, true});
            edges_.push_back({face[(k + 2) % 3], i, false});
            normals_.push_back(normal_of_face(mesh_.V, face));
        }
        std::sort(edges_.begin(), edges_.end());
    }

    Root root_of(uint32_t i) {
        bool turned = false;
        while (parent_[i] != i) {
            const uint32_t above = parent_[i];
            turned_[i] ^= turned_[above];
            parent_[i] = parent_[above];
            turned ^= bool(turned_[i]);
            i = parent_[i];
        }
        return {i, turned};
    }

    void join(const Edge& a, const Edge& b) {
        const bool against = a.leaves == b.leaves;
        const Vec3d &n = normals_[a.corner], &m = normals_[b.corner];
        const bool has_angle = !n.isZero(0) && !m.isZero(0);
        if (has_angle && (against ? -n.dot(m) : n.dot(m)) < least_) return;
        const Root first = root_of(a.corner), second = root_of(b.corner);
        if (first.corner == second.corner) return;
        const uint32_t later = std::max(first.corner, second.corner);
        parent_[later] = std::min(first.corner, second.corner);
        turned_[later] = char(first.turned ^ second.turned ^ against);
    }

    const UnitedMesh& mesh_;
    const double least_;
    std::vector<uint32_t> parent_;
    std::vector<char> turned_;  ///< against the parent
    std::vector<Edge> edges_;
    std::vector<Vec3d> normals_;
};

std::vector<uint32_t> grouped(const UnitedMesh& mesh, const std::vector<KeyedIndex>& corners,
                              const std::vector<size_t>& runs, double least) {
    std::vector<uint32_t> keys(corners.size());
    parallel_chunks(runs.size() - 1, crease_grain / 8, [&](size_t begin, size_t end) {
        CornerGroups groups(mesh, least);
        for (size_t r = begin; r < end; ++r) {
            const size_t count = runs[r + 1] - runs[r];
            groups.group(std::span(corners).subspan(runs[r], count), std::span(keys).subspan(runs[r], count));
        }
    });
    return keys;
}

/// Numbers what differs at one vertex: the first keeps the vertex, the others are appended.
class Numbers {
  public:
    explicit Numbers(Eigen::Index vertices) : next_(int32_t(vertices)) {}

    void clear() { known_.clear(); }
    void add(int32_t vertex, uint32_t key) { known_.push_back({vertex, key, vertex}); }
    /// After all of the vertex were added.
    void number(std::vector<int32_t>& repeated) {
        std::sort(known_.begin(), known_.end());
        known_.erase(std::unique(known_.begin(), known_.end()), known_.end());
        for (size_t i = 1; i < known_.size(); ++i) {
            if (known_[i].vertex != known_[i - 1].vertex) continue;
            known_[i].number = next_++;
            repeated.push_back(known_[i].vertex);
        }
    }
    int32_t of(int32_t vertex, uint32_t key) const {
        return std::lower_bound(known_.begin(), known_.end(), Known{vertex, key, 0})->number;
    }
    /// Calls visit(a, b) for the numbers of faces that are wound against each other.
    template <class Visit>
    void for_each_opposite(Visit&& visit) const {
        for (size_t i = 1; i < known_.size(); ++i)
            if (known_[i].key == (known_[i - 1].key | 1) && known_[i].key != known_[i - 1].key)
                visit(known_[i - 1].number, known_[i].number);
    }

  private:
    struct Known {
        int32_t vertex;
        uint32_t key;
        int32_t number;
        bool operator<(const Known& o) const { return std::tie(vertex, key) < std::tie(o.vertex, o.key); }
        bool operator==(const Known& o) const { return vertex == o.vertex && key == o.key; }
    };
    int32_t next_;
    std::vector<Known> known_;
};

std::vector<int32_t> rows_then(Eigen::Index count, const std::vector<int32_t>& repeated) {
    std::vector<int32_t> rows(size_t(count) + repeated.size());
    std::iota(rows.begin(), rows.begin() + count, 0);
    std::ranges::copy(repeated, rows.begin() + count);
    return rows;
}

/// Normals of the mesh's vertices.
Array3f normals_by_side(const MeshData& mesh, const Array3f& united_V, const Creases& creases) {
    const Array3f V = rows_of(united_V, rows_then(united_V.rows(), creases.vertices));
    Array3f::Dense sums = detail::normal_sums(V, creases.sides);
    for (const auto& [a, b] : creases.opposite) {
        sums.row(a) -= sums.row(b).eval();
        sums.row(b) = -sums.row(a);
    }
    Array3f of_sides = detail::directions(std::move(sums));
    if (creases.sides.revision() == creases.F.revision()) return of_sides;
    Array3f::Dense N = Array3f::Dense::Zero(mesh.V.rows(), 3);
    N.col(2).setOnes();
    for (Eigen::Index i = 0; i < mesh.F.size(); ++i)
        N.row(mesh.F.data()[i]) = of_sides.row(creases.sides.data()[i]);
    return Array3f(std::move(N));
}

}  // namespace

std::optional<Array3f> rest_positions(const MeshData& mesh) {
    const RestShape& rest = mesh.rest_shape;
    if (rest.V.empty() || rest.V.rows() != mesh.V.rows() || rest.F_revision != mesh.F.revision()) return {};
    return rest.V;
}

Creases find_creases(const MeshData& mesh, float crease_angle_deg) {
    MeshData shape;
    shape.V = rest_positions(mesh).value_or(mesh.V);
    shape.F = mesh.F, shape.source_vertex = mesh.source_vertex;
    const UnitedMesh united(shape);
    const double least = least_cosine(crease_angle_deg);
    const std::vector<KeyedIndex> corners = corners_at(united.F, leaning_vertices(united, least));
    const std::vector<size_t> runs = runs_of(corners);
    const std::vector<uint32_t> keys = grouped(united, corners, runs, least);
    if (std::ranges::all_of(keys, [](uint32_t key) { return key == 0; })) return {};
    Creases creases;
    Array3i::Dense F = mesh.F, sides = united.F;
    Numbers rows(mesh.V.rows()), normals(united.V.rows());
    for (size_t r = 0; r + 1 < runs.size(); ++r) {
        rows.clear(), normals.clear();
        for (size_t i = runs[r]; i < runs[r + 1]; ++i) {
            rows.add(mesh.F.data()[corners[i].index], keys[i]);
            normals.add(int32_t(corners[i].key), keys[i]);
        }
        rows.number(creases.rows);
        normals.number(creases.vertices);
        for (size_t i = runs[r]; i < runs[r + 1]; ++i) {
            const uint32_t corner = corners[i].index;
            F.data()[corner] = rows.of(mesh.F.data()[corner], keys[i]);
            sides.data()[corner] = normals.of(int32_t(corners[i].key), keys[i]);
        }
        normals.for_each_opposite([&](int32_t a, int32_t b) { creases.opposite.emplace_back(a, b); });
    }
    creases.F = std::move(F);
    creases.sides = mesh.source_vertex.empty() ? creases.F : Array3i(std::move(sides));
    return creases;
}

std::vector<int32_t> split_creases(MeshData& mesh, const Creases& creases) {
    std::vector<int32_t> rows = rows_then(mesh.V.rows(), creases.rows);
    mesh.uv_tangents = {};
    if (creases.empty()) {
        mesh.N = smooth_normals(mesh);
        return rows;
    }
    const UnitedMesh united(mesh);
    const FaceValues values(mesh);
    if (!creases.rows.empty()) repeat_vertices(rows, mesh);
    mesh.F = creases.F;
    mesh.N = normals_by_side(mesh, united.V, creases);
    values.put_back(mesh);
    rows.resize(size_t(mesh.V.rows()), rows.empty() ? 0 : rows.back());
    return rows;
}

std::vector<int32_t> split_creases(MeshData& mesh, float crease_angle_deg) {
    return split_creases(mesh, find_creases(mesh, crease_angle_deg));
}

void add_drawn_normals(MeshData& mesh) {
    const bool flat = mesh.style.flat.value_or(false);
    // What is drawn flat has the normals of its faces as they are now.
    if (flat) mesh.rest_shape = {};
    const Creases creases = find_creases(mesh, flat ? 0 : automatic_crease_deg);
    const Array4f tangents = mesh.uv_tangents;
    split_creases(mesh, creases);
    if (creases.empty()) mesh.uv_tangents = tangents;
}

void fill_normals(MeshData& mesh, float crease_angle_deg) {
    const Array3f given = mesh.N;
    const auto is_given = [&](int32_t vertex) { return !given.row(vertex).isZero(0); };
    MeshData split;
    split.V = mesh.V, split.F = mesh.F, split.source_vertex = mesh.source_vertex;
    const std::vector<int32_t> rows = split_creases(split, crease_angle_deg);
    // Of the rows after the split those that are kept, and the place of each.
    std::vector<int32_t> kept, place;
    for (int32_t i = 0; i < int32_t(rows.size()); ++i) {
        const bool is_kept = i < given.rows() || !is_given(rows[size_t(i)]);
        place.push_back(is_kept ? int32_t(kept.size()) : rows[size_t(i)]);
        if (is_kept) kept.push_back(i);
    }
    Array3f::Dense N = rows_of(split.N, kept);
    Array3i::Dense F = split.F;
    for (Eigen::Index i = 0; i < F.size(); ++i) F.data()[i] = place[size_t(F.data()[i])];
    for (size_t i = 0; i < kept.size(); ++i) {
        kept[i] = rows[size_t(kept[i])];
        if (is_given(kept[i])) N.row(Eigen::Index(i)) = given.row(kept[i]);
    }
    const FaceValues values(mesh);
    if (kept.size() > size_t(given.rows())) repeat_vertices(kept, mesh);
    mesh.uv_tangents = {};
    mesh.F = std::move(F);
    mesh.N = std::move(N);
    values.put_back(mesh);
}

void split_creases(const Mesh& mesh, float crease_angle_deg) {
    const auto data = mesh.snapshot();
    if (!data->F.empty() && data->N.empty() && !data->style.flat.value_or(false))
        Mesh(mesh).edit([&](MeshData& edited) { split_creases(edited, crease_angle_deg); });
    for (const Mesh& child : data->children) split_creases(child, crease_angle_deg);
}

}  // namespace easypbr
