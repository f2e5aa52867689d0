#include "easypbr/render/raster/face_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "easypbr/core/parallel.h"
#include "easypbr/render/raster/curve_order.h"

namespace easypbr::render {
namespace {

using Cluster = FaceClusters::Cluster;
using native::ClusterFaces;

/// Faces that one thread clusters at once. Few, so that what it needs for that is small.
constexpr size_t piece_faces = size_t(1) << 16;
/// Faces by which the order of all is judged.
constexpr size_t tried_faces = size_t(1) << 20;
/// With more vertices than that many clusters project each of them several times.
constexpr double most_vertices_per_face = 0.9;

/// Sets the sphere and the cone. meshoptimizer's meshopt_computeMeshletBounds() ends the program where a
/// vertex is not a number.
void bound(const Array3f& V, const uint32_t* ids, const uint8_t* corners, Cluster& cluster) {
    const auto vertex = [&](int i) { return Vec3d(V.row(ids[i]).transpose().cast<double>()); };
    Box3d box;
    for (int i = 0; i < cluster.vertex_count; ++i) {
        if (!vertex(i).allFinite()) {
            cluster.radius = std::numeric_limits<float>::infinity();
            return;
        }
        box.extend(vertex(i));
    }
    cluster.center = box.center().cast<float>();
    for (int i = 0; i < cluster.vertex_count; ++i)
        cluster.radius = std::max(cluster.radius, float((vertex(i) - cluster.center.cast<double>()).norm()));
    std::array<Vec3d, ClusterFaces::most_faces> normals;
    Vec3d sum = Vec3d::Zero();
    for (int i = 0; i < cluster.face_count; ++i) {
        const uint8_t* const c = corners + 3 * i;
        const Vec3d a = vertex(c[0]);
        normals[size_t(i)] = (vertex(c[1]) - a).cross(vertex(c[2]) - a).normalized();
        sum += normals[size_t(i)];
    }
    const Vec3d axis = sum.normalized();
    double least = 1;
    for (int i = 0; i < cluster.face_count; ++i)
        if (!normals[size_t(i)].isZero(0)) least = std::min(least, normals[size_t(i)].dot(axis));
    if (!(least > 0)) return;
    cluster.axis = axis.cast<float>();
    cluster.spread = float(std::sqrt(std::max(0.0, 1 - least * least)));
}

/// The vertices of a cluster that is being made. meshoptimizer's meshopt_buildMeshletsScan() does the same,
/// but clears memory for all vertices of the mesh in each call, and takes buffers for the worst case, which
/// kept 500 MB from the system for 25 million faces.
class ClusterVertices {
  public:
    ClusterVertices() { clear(); }
    void clear() {
        places_.fill(nowhere);
        count_ = 0;
    }
    int count() const { return count_; }
    const uint32_t* ids() const { return ids_.data(); }
    /// The place of a vertex, which it gets where it has none.
    uint8_t place_of(uint32_t id) {
        for (size_t slot = id * 2654435761u >> (32 - slot_bits);; slot = (slot + 1) % slots) {
            if (places_[slot] == nowhere) {
                ids_[size_t(count_)] = id;
                places_[slot] = uint8_t(count_++);
                return places_[slot];
            }
            if (ids_[places_[slot]] == id) return places_[slot];
        }
    }
    /// Whether there is room for another face.
    bool has_room() const { return count_ + 3 <= ClusterFaces::most_vertices; }

  private:
    static constexpr int slot_bits = 10;
    static constexpr size_t slots = size_t(1) << slot_bits;
    static constexpr uint8_t nowhere = 255;

    std::array<uint8_t, slots> places_;
    std::array<uint32_t, ClusterFaces::most_vertices> ids_;
    int count_ = 0;
};

}  // namespace

std::vector<Cluster> FaceClusters::make_piece(const Array3f& V, const Array3i& F, const MeshPart& part,
                                              size_t first, size_t count, std::vector<float>& copies) {
    const int32_t* const own = F.data() + 3 * size_t(part.first_face);
    std::vector<Cluster> made;
    std::vector<uint32_t> ids;  // of all clusters' vertices
    ClusterVertices vertices;
    std::array<uint8_t, 3 * ClusterFaces::most_faces> corners;
    for (size_t face = first; face < first + count;) {
        Cluster cluster{.first_face = uint32_t(face)};
        vertices.clear();
        for (; face < first + count && cluster.face_count < ClusterFaces::most_faces && vertices.has_room();
             ++face, ++cluster.face_count) {
            const int32_t* const f = own + 3 * size_t(order_.empty() ? face : order_[face]);
            for (size_t k = 0; k < 3; ++k)
                corners[3 * size_t(cluster.face_count) + k] = vertices.place_of(uint32_t(f[k]));
        }
        cluster.vertex_count = vertices.count();
        bound(V, vertices.ids(), corners.data(), cluster);
        for (size_t i = 0; i < 3 * size_t(cluster.face_count); ++i)
            corners_[3 * size_t(cluster.first_face) + i % 3 * size_t(cluster.face_count) + i / 3] =
                corners[i];
        ids.insert(ids.end(), vertices.ids(), vertices.ids() + vertices.count());
        made.push_back(cluster);
    }
    copies.assign(3 * ids.size() + ClusterFaces::most_vertices, 0.0f);
    float* copy = copies.data();
    const uint32_t* id = ids.data();
    for (Cluster& cluster : made) {
        cluster.vertices = copy;
        for (Eigen::Index k = 0; k < 3; ++k)
            for (int i = 0; i < cluster.vertex_count; ++i) *copy++ = V(id[i], k);
        id += cluster.vertex_count;
    }
    return made;
}

FaceClusters::FaceClusters(const Array3f& V, const Array3i& F, const MeshPart& part) {
    std::vector<std::vector<Cluster>> pieces;
    const auto make = [&](size_t count) {
        corners_.resize(3 * count + ClusterFaces::most_faces);
        pieces.assign((count + piece_faces - 1) / piece_faces, {});
        vertices_ = std::vector<std::vector<float>>(pieces.size());
        parallel_for(pieces.size(), 1, [&](size_t i) {
            const size_t first = i * piece_faces;
            pieces[i] = make_piece(V, F, part, first, std::min(piece_faces, count - first), vertices_[i]);
        });
    };
    const auto count = size_t(part.face_count), tried = std::min(tried_faces, count);
    make(tried);
    size_t vertices = 0;
    for (const auto& piece : pieces)
        for (const Cluster& cluster : piece) vertices += size_t(cluster.vertex_count);
    const bool reorders = double(vertices) > most_vertices_per_face * double(tried);
    if (reorders)
        order_ = curve_order(
            V, count, [&](size_t face) { return size_t(F.data()[3 * (size_t(part.first_face) + face)]); });
    if (reorders || tried < count) make(count);
    size_t all = 0;
    for (const auto& piece : pieces) all += piece.size();
    clusters_.reserve(all);
    for (const auto& piece : pieces) clusters_.insert(clusters_.end(), piece.begin(), piece.end());
}

const FaceClusters* ClusteredMeshes::draw(const MeshData& mesh, const MeshPart& part) {
    if (part.face_count < small_part) return nullptr;
    Entry& entry = entries_.get(key_of(mesh, part), [] { return Entry(); });
    if (++entry.draws == 2)
        entry.clusters = std::make_unique<BackgroundValue<FaceClusters>>(
            [V = mesh.V, F = mesh.F, part] { return FaceClusters(V, F, part); });
    return find(mesh, part);
}

const FaceClusters* ClusteredMeshes::find(const MeshData& mesh, const MeshPart& part) const {
    const Entry* const entry = entries_.find(key_of(mesh, part));
    return entry && entry->clusters ? entry->clusters->get() : nullptr;
}

}  // namespace easypbr::render
