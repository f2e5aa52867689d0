// Meshes made of some of the vertices and faces of another, with all that belongs to them.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

/// Throws ArgumentError "WHAT: expected a mesh with faces ..." (or vertices, or splats) when there are none;
/// says what to do when only the descendants have some.
void require_faces(const char* what, const MeshData& mesh);
void require_vertices(const char* what, const MeshData& mesh);
void require_splats(const char* what, const MeshData& mesh);

/// Name, source, label map, materials, style, pose and clones of the children, but none of the arrays and
/// parts.
MeshData clone_without_arrays(const MeshData& mesh);

/// The vertices alone, in the order given (an index may come more than once), with all that they have. Faces,
/// edges and what belongs to faces are left out. source_vertex leads to the file's vertices, or to those of
/// the given mesh when it has none.
MeshData gather_vertices(const MeshData& mesh, const std::vector<int32_t>& vertices);

/// Which parts of a mesh stay.
struct Selection {
    std::vector<int32_t> vertices;  ///< old indices of the new vertices
    std::vector<int32_t> place;     ///< for each old vertex the new one that stands for it, or -1
    std::vector<int32_t> faces;     ///< old indices of the new faces, rising; their vertices all have a place
    std::vector<int32_t> edges;     ///< the same of the edges
};

/// Everything of the mesh. Its functions change one list, and what depends on it.
Selection select_all(const MeshData& mesh);
/// Faces without three different places, and edges without two, are taken out.
void drop_degenerate(Selection& selection, const MeshData& mesh);
/// Vertices that no chosen face and edge uses are taken out.
void drop_unreferenced(Selection& selection, const MeshData& mesh);

/// The chosen vertices, faces and edges with all that belongs to them; parts, also those left without a face,
/// materials, style, pose, clones of the children. Values of faces that could be taken for values of
/// vertices, because there are as many now, are left out with a warning.
MeshData chosen(const MeshData& mesh, const Selection& selection);

}  // namespace easypbr::geometry
