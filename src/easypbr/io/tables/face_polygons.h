// Triangles joined to the polygons that they are of: what formats with polygons are written of.
#pragma once

#include <span>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// The faces of a mesh, in their order. Triangles that follow each other, with one number in source_face, in
/// one part, with the same labels and scalars, are one polygon where that is exactly their surface: they are
/// bounded by one loop through all of their corners, each once, and are what triangulate() cuts it into, or
/// lie in a plane. All others are triangles.
class FacePolygons {
  public:
    explicit FacePolygons(const MeshData& mesh);
    /// The triangles alone.
    explicit FacePolygons(const Array3i& F) : F_(F) {}

    size_t size() const { return face_.empty() ? size_t(F_.rows()) : face_.size(); }
    /// Where the corners of a polygon begin among those of all; for size(), their number.
    size_t first_corner(size_t polygon) const { return face_.empty() ? 3 * polygon : first_[polygon]; }
    std::span<const int32_t> corners(size_t polygon) const;
    size_t most_corners() const;
    /// The first triangle of a polygon.
    Eigen::Index face(size_t polygon) const {
        return face_.empty() ? Eigen::Index(polygon) : Eigen::Index(face_[polygon]);
    }
    /// How many polygons begin before this triangle.
    size_t polygons_before(Eigen::Index face) const;

  private:
    Array3i F_;
    // Empty where polygons are the triangles.
    std::vector<size_t> first_;
    std::vector<int32_t> corners_, face_;
};

}  // namespace easypbr::io
