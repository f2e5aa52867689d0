// Meshes with less in them that is of no use, and turned around.
#pragma once

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// Vertices that no face and no edge uses are left out. A mesh without faces and edges is a cloud, and stays
/// as it is.
Mesh remove_unreferenced_vertices(const Mesh& mesh);

/// Which vertices are the same.
struct DuplicateOptions {
    double tolerance = 0;  ///< largest distance, in the mesh's unit
    /// Whether vertices must also have the same attributes. Otherwise seams of texture coordinates and hard
    /// edges are welded: the first vertex's attributes stay, and the normals become the mean.
    bool keep_seams = true;
};

/// Of vertices that are the same the first one stays; faces and edges that lose their extent by that are left
/// out. With a tolerance, a vertex joins the first earlier one within it that joined no other. Throws
/// ArgumentError unless tolerance >= 0.
Mesh remove_duplicate_vertices(const Mesh& mesh, const DuplicateOptions& options = {});

/// Faces without area are left out: those that have two corners at one place, or three on a line.
Mesh remove_degenerate_faces(const Mesh& mesh);

/// Faces turned around; normals stay.
Mesh flip_winding(const Mesh& mesh);
/// Normals turned around; faces stay.
Mesh flip_normals(const Mesh& mesh);

}  // namespace easypbr
