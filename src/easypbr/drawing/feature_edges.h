// Edges of meshes that a line drawing shows.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "easypbr/scene/eye.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::drawing {

struct FeatureEdge {
    std::array<Vec3d, 2> ends;                     ///< world
    std::array<int32_t, 2> places{-1, -1};         ///< numbers of the ends among the mesh's positions
    std::array<Eigen::Index, 2> faces = {-1, -1};  ///< of the mesh, that meet there; -1: none
};

struct FeatureKinds {
    bool contours = true;  ///< between a face that faces the viewer and one that does not, and borders
    bool creases = true;   ///< between faces whose normals differ by more than crease_angle_deg
    double crease_angle_deg = 40;
};

/// Of the faces of a mesh. Vertices at the same place are one position, so that seams are no borders; faces
/// without area have no contours and no creases. In the order of their positions.
std::vector<FeatureEdge> feature_edges(const MeshData& mesh, const Eigen::Affine3d& T_world_mesh,
                                       const Eye& eye, const FeatureKinds& kinds);

/// MeshData::E, all of them.
std::vector<FeatureEdge> line_segments(const MeshData& mesh, const Eigen::Affine3d& T_world_mesh);

}  // namespace easypbr::drawing
