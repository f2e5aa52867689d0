// Normals and surfels from points.
#pragma once

#include <optional>

#include "easypbr/scene/mesh.h"

namespace easypbr {

struct NeighborhoodOptions {
    /// Neighbours of a point that its surface is estimated from, 3 to 256; all others when there are fewer.
    int k = 16;
    /// Normals are turned towards this point (of the mesh's own frame, offset included), as where a scanner
    /// stood. Without one, those of neighbours agree, and closed shapes face outwards, open ones the positive
    /// side of the axis nearest to their mean normal, so that ground faces up.
    std::optional<Vec3d> viewpoint;
};

/// The mesh with the normals of the planes that fit the k nearest neighbours of each vertex best, near ones
/// counting more (Hoppe et al. 1992). Vertices at the same place count once and get the same normal. In
/// parallel; does not depend on the number of threads. Throws ArgumentError for a k out of range, fewer than
/// three different points, or a viewpoint that is not finite.
Mesh estimate_normals(const Mesh& mesh, const NeighborhoodOptions& options = {});

/// The vertices as surfels: oriented ellipses that cover the surface without holes. N are the normals of
/// estimate_normals(), or those of the mesh when it has some and `keep_normals` is set; T is one semi-axis, B
/// the length of the other one, along N x T (the paper's surfel). The ellipses follow the pattern of the
/// points, longer where they are farther apart. Faces and edges are left out. Throws as estimate_normals()
/// does.
Mesh estimate_surfels(const Mesh& mesh, const NeighborhoodOptions& options = {}, bool keep_normals = false);

/// One surfel for each vertex that a face uses, with the mesh's normals (computed when it has none) and
/// ellipses that cover the vertex's share of the faces around it; of splats see surfels_from_splats(). Throws
/// ArgumentError when there are no faces.
Mesh surfels_from_mesh(const Mesh& mesh);

/// One surfel for each splat: across its shortest axis, with ellipses as large as a disc that covers what the
/// Gaussian does (semi-axes of sqrt(2) standard deviations), colours and alpha as those of
/// cloud_from_splats(). Throws ArgumentError when the mesh has no splats.
Mesh surfels_from_splats(const Mesh& mesh);

}  // namespace easypbr
