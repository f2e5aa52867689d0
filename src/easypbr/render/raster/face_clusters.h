// Faces that share vertices, in groups: what the raster sets up many at once, or leaves out as a whole.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "easypbr/core/background.h"
#include "easypbr/core/math.h"
#include "easypbr/core/revision_cache.h"
#include "easypbr/native/kernels.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::render {

class FaceClusters {
  public:
    struct Cluster {
        uint32_t first_face = 0;  ///< place in the list of all faces
        int face_count = 0, vertex_count = 0;
        const float* vertices = nullptr;  ///< all x, all y, all z. Lanes beyond them can be read
        Vec3 center{0, 0, 0};             ///< of a sphere around the vertices
        float radius = 0;
        Vec3 axis{0, 0, 0};  ///< of a cone that the normals lie in
        float spread = 1;    ///< sine of the cone's half angle; 1 where it is no cone
    };

    FaceClusters() = default;
    FaceClusters(FaceClusters&&) = default;
    FaceClusters& operator=(FaceClusters&&) = default;
    /// Of a range of faces, on all cores: in the order that they have, or, where neighbours there share few
    /// vertices, by place.
    FaceClusters(const Array3f& V, const Array3i& F, const MeshPart& part);

    std::span<const Cluster> clusters() const { return clusters_; }
    /// Its vertices that are the first corners of all its faces, the second ones, the third ones. Lanes
    /// beyond them can be read.
    const uint8_t* corners_of(const Cluster& cluster) const {
        return &corners_[3 * size_t(cluster.first_face)];
    }
    /// The number in the range of a cluster's face.
    uint32_t face_of(const Cluster& cluster, int face) const {
        const size_t place = size_t(cluster.first_face) + size_t(face);
        return order_.empty() ? uint32_t(place) : order_[place];
    }

  private:
    /// Makes the clusters of consecutive faces; `vertices` becomes what they refer to.
    std::vector<Cluster> make_piece(const Array3f& V, const Array3i& F, const MeshPart& part, size_t first,
                                    size_t count, std::vector<float>& vertices);

    std::vector<Cluster> clusters_;
    std::vector<std::vector<float>> vertices_;  ///< copies: those of a cluster are together in memory
    std::vector<uint8_t> corners_;
    std::vector<uint32_t> order_;  ///< faces by place; empty: in their own order
};

/// The clusters of parts of meshes, by the revisions of their geometry.
class ClusteredMeshes {
  public:
    /// Takes note that a part is drawn. Its clusters begin to be made when it is drawn for the second
    /// time: a single picture would not earn them back. Null until there are any.
    const FaceClusters* draw(const MeshData& mesh, const MeshPart& part);
    /// The same of a part that is not noted.
    const FaceClusters* find(const MeshData& mesh, const MeshPart& part) const;
    void evict_unused() { entries_.evict_unused(); }

  private:
    /// Faces that are drawn in a millisecond.
    static constexpr int small_part = 1 << 15;
    struct Entry {
        int draws = 0;
        std::unique_ptr<BackgroundValue<FaceClusters>> clusters;
    };
    using Key = std::tuple<uint64_t, uint64_t, int, int>;
    static Key key_of(const MeshData& mesh, const MeshPart& part) {
        return {mesh.V.revision(), mesh.F.revision(), part.first_face, part.face_count};
    }

    RevisionCache<Key, Entry> entries_;
};

}  // namespace easypbr::render
