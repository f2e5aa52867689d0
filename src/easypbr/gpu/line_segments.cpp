#include "easypbr/gpu/line_segments.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/normals.h"

namespace easypbr::gpu {
namespace {

constexpr size_t segment_grain = 1 << 14;
/// Length of normals, as a part of the mesh's diagonal.
constexpr float normal_part = 0.02f;

void put(float (&to)[3], const Array3f& V, Eigen::Index row) {
    for (int k = 0; k < 3; ++k) to[k] = V(row, k);
}

Segment segment_between(const MeshData& mesh, Eigen::Index a, Eigen::Index b) {
    Segment segment;
    put(segment.a, mesh.V, a);
    put(segment.b, mesh.V, b);
    if (!mesh.C.empty()) {
        segment.color_a = rgba8(mesh.C, a);
        segment.color_b = rgba8(mesh.C, b);
    }
    if (mesh.UV.empty()) return segment;
    const float place_a = mesh.UV(a, 0), place_b = mesh.UV(b, 0);
    if (std::isnan(place_a) || std::isnan(place_b)) {
        segment.row = row_of_nothing;
    } else {
        segment.places[0] = place_a;
        segment.places[1] = place_b;
    }
    return segment;
}

struct Edge {
    uint64_t key;      ///< smaller vertex in the upper, larger in the lower half
    int32_t from, to;  ///< corners in F
    int32_t face() const { return from / 3; }
    bool operator<(const Edge& other) const { return key != other.key ? key < other.key : from < other.from; }
};

/// For each vertex the first one that was split from the same (source_vertex) and stands at the same place;
/// empty: each is one of its own.
std::vector<int32_t> united_vertices(const MeshData& mesh) {
    if (mesh.source_vertex.empty()) return {};
    const Array1i source = numbers_below(2 * mesh.source_vertex.rows(), mesh.source_vertex);
    std::vector<int32_t> first(size_t(source.maxCoeff()) + 1, -1), united(size_t(source.rows()));
    for (int32_t i = 0; i < int32_t(source.rows()); ++i) {
        int32_t& known = first[size_t(source(i))];
        if (known < 0) known = i;
        united[size_t(i)] = mesh.V.row(known) == mesh.V.row(i) ? known : i;
    }
    return united;
}

std::vector<Edge> face_edges(const MeshData& mesh) {
    const std::vector<int32_t> united = united_vertices(mesh);
    const auto vertex = [&](int32_t corner) {
        const int32_t own = mesh.F.data()[corner];
        return uint64_t(united.empty() ? own : united[size_t(own)]);
    };
    std::vector<Edge> edges(size_t(mesh.F.size()));
    parallel_for(edges.size(), segment_grain, [&](size_t i) {
        int32_t from = int32_t(i), to = int32_t(i % 3 == 2 ? i - 2 : i + 1);
        if (vertex(from) > vertex(to)) std::swap(from, to);
        edges[i] = {vertex(from) << 32 | vertex(to), from, to};
    });
    std::sort(edges.begin(), edges.end());
    return edges;
}

}  // namespace

std::vector<Segment> edge_segments(const MeshData& mesh) {
    std::vector<Segment> segments(size_t(mesh.E.rows()));
    parallel_for(segments.size(), segment_grain, [&](size_t i) {
        segments[i] = segment_between(mesh, mesh.E(Eigen::Index(i), 0), mesh.E(Eigen::Index(i), 1));
    });
    return segments;
}

std::vector<ChainStep> edge_chains(const MeshData& mesh) {
    const auto vertices = size_t(mesh.V.rows()), edges = size_t(mesh.E.rows());
    const auto vertex = [&](size_t edge, int end) { return size_t(mesh.E(Eigen::Index(edge), end)); };
    // The edges at each vertex, one after the other.
    std::vector<uint32_t> first(vertices + 1), at(2 * edges);
    for (size_t i = 0; i < edges; ++i)
        for (const int end : {0, 1}) ++first[vertex(i, end) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<uint32_t> next(first.begin(), first.end() - 1);
    for (size_t i = 0; i < edges; ++i)
        for (const int end : {0, 1}) at[next[vertex(i, end)]++] = uint32_t(i);
    std::vector<ChainStep> steps;
    steps.reserve(edges);
    std::vector<uint8_t> taken(edges);
    const auto follow = [&](size_t from, uint32_t edge) {
        for (bool begins = true; !taken[edge]; begins = false) {
            taken[edge] = 1;
            const bool reversed = vertex(edge, 0) != from;
            steps.push_back({edge, reversed, begins});
            from = vertex(edge, reversed ? 0 : 1);
            if (first[from + 1] - first[from] != 2) return;
            edge = at[first[from]] == edge ? at[first[from] + 1] : at[first[from]];
        }
    };
    for (size_t i = 0; i < vertices; ++i)
        if (first[i + 1] - first[i] != 2)
            for (uint32_t k = first[i]; k < first[i + 1]; ++k) follow(i, at[k]);
    for (size_t i = 0; i < edges; ++i) follow(vertex(i, 0), uint32_t(i));
    return steps;
}

std::vector<Segment> wireframe_segments(const MeshData& mesh) {
    const std::vector<Edge> edges = face_edges(mesh);
    const auto polygon = [&](const Edge& edge) {
        return mesh.source_face.empty() ? edge.face() : mesh.source_face(edge.face());
    };
    std::vector<Segment> segments;
    for (size_t first = 0, last; first < edges.size(); first = last) {
        const Edge& edge = edges[first];
        bool inside = true;
        for (last = first + 1; last < edges.size() && edges[last].key == edge.key; ++last)
            inside &= polygon(edges[last]) == polygon(edge);
        if (last > first + 1 && inside) continue;
        segments.push_back(segment_between(mesh, mesh.F.data()[edge.from], mesh.F.data()[edge.to]));
    }
    return segments;
}

NormalLines normal_lines(std::optional<float> length, const Mat3d& pose) {
    NormalLines lines{length, {}};
    Mat3d metric = pose.transpose() * pose;
    const double square = metric.trace() / 3;
    // A rotation leaves rounding errors, which would tell poses of one scale apart.
    if ((metric - square * Mat3d::Identity()).norm() <= 1e-6 * square) metric = square * Mat3d::Identity();
    for (int i = 0; i < 9; ++i) lines.metric[size_t(i)] = float(metric(i / 3, i % 3));
    return lines;
}

std::vector<Segment> normal_segments(const MeshData& mesh, const NormalLines& lines) {
    if (mesh.N.empty() && mesh.F.empty()) return {};
    const Array3f N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
    Mat3d metric = Mat3(lines.metric.data()).cast<double>();
    Mat3d inverse = metric.inverse();
    if (!inverse.allFinite() || !(metric.determinant() > 0)) metric = inverse = Mat3d::Identity();
    const Vec3d diagonal =
        (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).transpose().cast<double>();
    const double length = lines.length
                              ? double(*lines.length)
                              : double(normal_part * float(std::sqrt(diagonal.dot(metric * diagonal))));
    std::vector<Segment> segments(size_t(mesh.V.rows()));
    parallel_for(segments.size(), segment_grain, [&](size_t i) {
        const auto row = Eigen::Index(i);
        Segment& segment = segments[i];
        put(segment.a, mesh.V, row);
        // In the world it is along L^-T n, whose square is n^T (L^T L)^-1 n; L^-1 takes it back.
        const Vec3d n = N.row(row).transpose().cast<double>(), along = inverse * n;
        const double square = n.dot(along);
        const Vec3 way =
            (square > 0 ? Vec3d(length / std::sqrt(square) * along) : Vec3d::Zero()).cast<float>();
        for (int k = 0; k < 3; ++k) segment.b[k] = mesh.V(row, k) + way[k];
    });
    return segments;
}

}  // namespace easypbr::gpu
