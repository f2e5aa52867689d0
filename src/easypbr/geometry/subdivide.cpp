#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/adjacency.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/remesh.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/weld.h"
#include "easypbr/scene/normals.h"

namespace easypbr {
namespace {

constexpr size_t subdivide_grain = 4096;

/// The edges of all faces, each once, by the vertices at its ends.
struct Edges {
    std::vector<std::array<int32_t, 2>> ends;  ///< the lower vertex first
    std::vector<int32_t> of_corner;            ///< 3 for each face: the edge from its corner to the next one
};

Edges find_edges(const Array3i& F) {
    std::vector<KeyedIndex> items(size_t(F.size()));
    parallel_for(items.size(), subdivide_grain, [&](size_t corner) {
        const auto f = Eigen::Index(corner / 3), k = Eigen::Index(corner % 3);
        const int32_t a = F(f, k), b = F(f, (k + 1) % 3);
        items[corner] = {uint64_t(std::min(a, b)) << 32 | uint64_t(std::max(a, b)), uint32_t(corner)};
    });
    parallel_sort(items);
    Edges edges;
    edges.of_corner.resize(items.size());
    for (size_t i = 0; i < items.size(); ++i) {
        if (i == 0 || items[i].key != items[i - 1].key)
            edges.ends.push_back({int32_t(items[i].key >> 32), int32_t(items[i].key & 0xffffffff)});
        edges.of_corner[items[i].index] = int32_t(edges.ends.size()) - 1;
    }
    return edges;
}

/// Old rows, then for each edge what `middle` makes of the rows of its ends.
template <class A, class Middle>
A extended(const A& array, const Edges& edges, Middle&& middle) {
    if (array.empty()) return {};
    typename A::Dense result(array.rows() + Eigen::Index(edges.ends.size()), array.cols());
    result.topRows(array.rows()) = array;
    parallel_for(edges.ends.size(), subdivide_grain, [&](size_t e) {
        result.row(array.rows() + Eigen::Index(e)) =
            middle(array.row(edges.ends[e][0]), array.row(edges.ends[e][1]));
    });
    return result;
}

template <class A>
A with_means(const A& array, const Edges& edges) {
    return extended(array, edges, [](const auto& a, const auto& b) { return ((a + b) / 2).eval(); });
}

Array3f with_mean_normals(const Array3f& N, const Edges& edges) {
    return extended(N, edges, [](const auto& a, const auto& b) {
        const Eigen::RowVector3f sum = a + b;
        const float length = sum.norm();
        return Eigen::RowVector3f(length > 1e-6f ? Eigen::RowVector3f(sum / length) : Eigen::RowVector3f(a));
    });
}

/// The rows of faces, four times each.
template <class A>
A handed_down(const A& array) {
    if (array.empty()) return {};
    typename A::Dense result(4 * array.rows(), array.cols());
    for (Eigen::Index f = 0; f < array.rows(); ++f) result.middleRows(4 * f, 4).rowwise() = array.row(f);
    return result;
}

Array3i cut_faces(const Array3i& F, const Edges& edges, Eigen::Index vertices) {
    Array3i::Dense result(4 * F.rows(), 3);
    parallel_for(size_t(F.rows()), subdivide_grain, [&](size_t face) {
        const auto f = Eigen::Index(face);
        const auto middle = [&](int k) { return int32_t(vertices) + edges.of_corner[3 * face + size_t(k)]; };
        const int32_t a = F(f, 0), b = F(f, 1), c = F(f, 2), ab = middle(0), bc = middle(1), ca = middle(2);
        result.middleRows(4 * f, 4) << a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca;
    });
    return result;
}

/// Positions by Loop's rules, in double, of old vertices and of the middles of edges. Vertices at one place
/// are one.
class LoopRules {
  public:
    explicit LoopRules(const MeshData& mesh) : mesh_(mesh), adjacency_(mesh) {
        Array3i::Dense F(mesh.F.rows(), 3);
        for (Eigen::Index i = 0; i < F.size(); ++i) F.data()[i] = place(mesh.F.data()[i]);
        edges_ = find_edges(Array3i(F));
        faces_.assign(edges_.ends.size(), 0);
        opposite_.assign(edges_.ends.size(), Vec3d::Zero());
        for (Eigen::Index f = 0; f < F.rows(); ++f)
            for (int k = 0; k < 3; ++k) {
                const auto edge = size_t(edges_.of_corner[3 * size_t(f) + size_t(k)]);
                ++faces_[edge];
                opposite_[edge] += at(F(f, (k + 2) % 3));
            }
    }

    Vec3d old_vertex(int32_t v) const {
        const int32_t center = place(v);
        const auto neighbors = adjacency_.of(center);
        if (neighbors.empty()) return at(center);
        if (adjacency_.is_border(center)) return border_vertex(center);
        // Warren's weights, which are Loop's own for the regular six neighbours.
        const double n = double(neighbors.size()), weight = neighbors.size() == 3 ? 3.0 / 16 : 3.0 / (8 * n);
        return (1 - n * weight) * at(center) + weight * sum_of(neighbors);
    }

    /// The middle of the edge from a corner (3 * face + k) to the next one.
    Vec3d new_vertex(size_t corner) const {
        const auto edge = size_t(edges_.of_corner[corner]);
        const Vec3d ends = at(edges_.ends[edge][0]) + at(edges_.ends[edge][1]);
        return faces_[edge] == 2 ? Vec3d(3 * ends / 8 + opposite_[edge] / 8) : Vec3d(ends / 2);
    }

  private:
    int32_t place(int32_t v) const { return adjacency_.weld().place[size_t(v)]; }

    Vec3d at(int32_t position) const {
        return mesh_.V.row(adjacency_.weld().first[size_t(position)]).transpose().cast<double>();
    }

    Vec3d sum_of(std::span<const int32_t> positions) const {
        Vec3d sum = Vec3d::Zero();
        for (const int32_t position : positions) sum += at(position);
        return sum;
    }

    /// On the curve of the border; a corner of it stays.
    Vec3d border_vertex(int32_t center) const {
        std::vector<int32_t> along;
        for (const int32_t neighbor : adjacency_.of(center))
            if (adjacency_.is_border_edge(center, neighbor)) along.push_back(neighbor);
        return along.size() == 2 ? Vec3d(0.75 * at(center) + 0.125 * sum_of(along)) : at(center);
    }

    const MeshData& mesh_;
    geometry::Adjacency adjacency_;
    Edges edges_;  ///< between positions
    std::vector<int> faces_;
    std::vector<Vec3d> opposite_;
};

Array3f loop_positions(const MeshData& mesh, const Edges& edges) {
    const LoopRules rules(mesh);
    Array3f::Dense V(mesh.V.rows() + Eigen::Index(edges.ends.size()), 3);
    parallel_for(size_t(mesh.V.rows()), subdivide_grain, [&](size_t v) {
        V.row(Eigen::Index(v)) = rules.old_vertex(int32_t(v)).cast<float>().transpose();
    });
    // Corners of one edge write the same numbers, so one of them is enough.
    std::vector<size_t> corner_of(edges.ends.size());
    for (size_t corner = 0; corner < edges.of_corner.size(); ++corner)
        corner_of[size_t(edges.of_corner[corner])] = corner;
    parallel_for(corner_of.size(), subdivide_grain, [&](size_t e) {
        V.row(mesh.V.rows() + Eigen::Index(e)) = rules.new_vertex(corner_of[e]).cast<float>().transpose();
    });
    return V;
}

/// Labels or scalars: means (or the first end's) of vertices, or those of faces handed down.
template <class A, class Middle>
A refined_values(const MeshData& mesh, const A& values, const Edges& edges, Middle&& middle) {
    if (values.empty()) return {};
    if (element_of(mesh, values.rows()) == PerElement::face) return handed_down(values);
    return extended(values, edges, middle);
}

MeshData refined(const MeshData& mesh, Subdivision subdivision) {
    const Edges edges = find_edges(mesh.F);
    const auto mean = [](const auto& a, const auto& b) { return ((a + b) / 2).eval(); };
    MeshData result = mesh;
    result.V = subdivision == Subdivision::loop ? loop_positions(mesh, edges) : with_means(mesh.V, edges);
    result.N = with_mean_normals(mesh.N, edges);
    result.C = with_means(mesh.C, edges);
    result.UV = with_means(mesh.UV, edges);
    // Between different signs the mean is 0: no tangent.
    if (subdivision == Subdivision::loop)
        result.uv_tangents = {};
    else
        result.uv_tangents = with_means(mesh.uv_tangents, edges);
    result.T = with_means(mesh.T, edges);
    result.B = with_means(mesh.B, edges);
    result.I = with_means(mesh.I, edges);
    result.L = refined_values(mesh, mesh.L, edges, [](const auto& a, const auto&) { return a; });
    for (ScalarArray& scalar : result.scalars)
        scalar.values = refined_values(mesh, scalar.values, edges, mean);
    result.F = cut_faces(mesh.F, edges, mesh.V.rows());
    result.source_face = handed_down(mesh.source_face);
    for (MeshPart& part : result.parts) {
        part.first_face *= 4;
        part.face_count *= 4;
    }
    return result;
}

}  // namespace

Mesh upsample(const Mesh& mesh, int iterations, Subdivision subdivision) {
    geometry::require_in("upsample: iterations", iterations, geometry::upsample_iterations);
    const auto data = mesh.snapshot();
    geometry::require_faces("upsample", *data);
    const double faces = double(data->F.rows()) * std::pow(4.0, iterations);
    if (faces * 3 > double(std::numeric_limits<int32_t>::max()))
        throw ArgumentError(fmt::format("upsample: expected at most {} faces, got {:.6g}",
                                        std::numeric_limits<int32_t>::max() / 3, faces));
    MeshData result = *data;
    for (Mesh& child : result.children) child = child.clone();
    for (int i = 0; i < iterations; ++i) result = refined(result, subdivision);
    if (iterations > 0) geometry::remember_seams(result);
    if (iterations > 0 && subdivision == Subdivision::loop && !result.N.empty())
        result.N = smooth_normals(result);
    return Mesh(std::move(result));
}

}  // namespace easypbr
