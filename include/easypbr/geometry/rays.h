// Rays against surfaces: what they meet, what lies between two points, inside and outside, what a camera
// sees.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// Faces of a mesh in a tree of bounding boxes, to cast rays against. Faces are met from both sides.
/// Immutable, shared by handle; queries from any thread, many at once in parallel. Computed in double
/// precision relative to the mesh's offset: points far from zero need nothing. Points are given with the
/// offset: offset + V is a vertex. Rays do not pass between faces that share an edge or a vertex, whether by
/// index or by equal positions.
class RayTree {
  public:
    /// The mesh and its descendants in the frame of its parent, as merged() has them; faces count in its
    /// order. Throws ArgumentError when there are no faces.
    explicit RayTree(const Mesh& mesh);
    /// The mesh's own faces, without pose and descendants. Throws for faces out of range, too.
    explicit RayTree(const MeshData& mesh);

    // Moving copies: a handle always has its object.
    RayTree(const RayTree& other) = default;
    RayTree& operator=(const RayTree& other) = default;

    Eigen::Index face_count() const;

    /// What each ray meets first. Of several faces at the same distance the first: so of faces with the same
    /// corners, however they are wound. Distances of other faces, as on a common edge, may differ by
    /// rounding.
    struct Hits {
        std::vector<double> distances;  ///< Euclidean, whatever the direction's length; infinity: none is met
        std::vector<int32_t> faces;     ///< -1: none; the rest of such a row is NaN
        std::vector<Vec3d> barycentric;  ///< weights of the face's three corners
        std::vector<Vec3d> points;
        std::vector<Vec3d> normals;  ///< of the face by its winding, unit; not turned towards the ray
    };

    /// Directions may have any length. Throws ArgumentError unless origins and directions are finite, no
    /// direction is zero, there are as many of both or one of either, which is all others', and
    /// max_distance >= 0.
    Hits cast(const Array3d& origins, const Array3d& directions,
              double max_distance = std::numeric_limits<double>::infinity()) const;

    /// Faces nearer to an end of a segment than this part of the diagonal of the bounding box are touched by
    /// it: they do not occlude. So a vertex does not hide itself.
    static constexpr double touch_part = 1e-6;

    /// 1 where a face lies between two points, else 0. Throws ArgumentError unless the points are finite and
    /// there are as many of both or one of either.
    std::vector<uint8_t> occluded(const Array3d& from, const Array3d& to) const;

    /// 1 where the surface winds around a point, else 0: inside. Needs a closed mesh whose faces are wound
    /// consistently, seen from outside counter-clockwise or clockwise; of several bodies that overlap, each.
    /// Edges may be closed by equal positions. What is said of points on the surface, and of meshes with
    /// holes, may be either. Throws ArgumentError when a point is not finite.
    std::vector<uint8_t> contains(const Array3d& points) const;

  private:
    struct Tree;
    std::shared_ptr<const Tree> tree_;
};

/// 1 for the vertices that are seen from a point, hidden by no face of the mesh, else 0: those of the mesh
/// and its descendants in the order and frame of merged(). The point is given with the offset. Vertices are
/// seen from either side of their faces. Throws ArgumentError when there are no faces or the point is not
/// finite.
std::vector<uint8_t> visible_vertices(const Mesh& mesh, const Vec3d& from);

/// The same for a camera. With a size only what lies in a picture of this size is seen. `origin`: what the
/// camera's pose is relative to, as Scene::origin(); else the mesh's offset, as in a scene that shows it
/// first. What is before the near plane neither is seen nor hides: `near`, as the setting camera.near, else
/// as views infer it, before all content in front of the camera; the camera's own near and far do not count,
/// as they do not for views. Throws ArgumentError for a size below 1 x 1 and a near that is not above 0, too.
std::vector<uint8_t> visible_vertices(const Mesh& mesh, const Camera& camera,
                                      const std::optional<Vec2i>& size = {},
                                      const std::optional<Vec3d>& origin = {},
                                      const std::optional<double>& near = {});

}  // namespace easypbr
