#include "easypbr/gpu/line_segments.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/normals.h"

namespace easypbr::gpu {
namespace {

constexpr size_t segment_grain = 1 << 14;

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
    uint64_t key;  ///< smaller index in the upper, larger in the lower half
    int32_t face;
    bool operator<(const Edge& other) const { return key != other.key ? key < other.key : face < other.face; }
};

std::vector<Edge> face_edges(const Array3i& F) {
    std::vector<Edge> edges(size_t(F.size()));
    parallel_for(edges.size(), segment_grain, [&](size_t i) {
        const size_t face = i / 3, corner = i % 3;
        const uint64_t a = uint64_t(F.data()[i]), b = uint64_t(F.data()[3 * face + (corner + 1) % 3]);
        edges[i] = {std::min(a, b) << 32 | std::max(a, b), int32_t(face)};
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

std::vector<Segment> wireframe_segments(const MeshData& mesh) {
    const std::vector<Edge> edges = face_edges(mesh.F);
    const auto polygon = [&](const Edge& edge) {
        return mesh.source_face.empty() ? edge.face : mesh.source_face(edge.face);
    };
    std::vector<Segment> segments;
    for (size_t first = 0, last; first < edges.size(); first = last) {
        bool inside = true;
        for (last = first + 1; last < edges.size() && edges[last].key == edges[first].key; ++last)
            inside &= polygon(edges[last]) == polygon(edges[first]);
        if (last > first + 1 && inside) continue;
        segments.push_back(segment_between(mesh, Eigen::Index(edges[first].key >> 32),
                                           Eigen::Index(edges[first].key & 0xffffffffu)));
    }
    return segments;
}

std::vector<Segment> normal_segments(const MeshData& mesh, float length) {
    if (mesh.N.empty() && mesh.F.empty()) return {};
    const Array3f N = mesh.N.empty() ? smooth_normals(mesh) : mesh.N;
    std::vector<Segment> segments(size_t(mesh.V.rows()));
    parallel_for(segments.size(), segment_grain, [&](size_t i) {
        const auto row = Eigen::Index(i);
        Segment& segment = segments[i];
        put(segment.a, mesh.V, row);
        for (int k = 0; k < 3; ++k) segment.b[k] = mesh.V(row, k) + length * N(row, k);
    });
    return segments;
}

}  // namespace easypbr::gpu
