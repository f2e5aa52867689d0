// Sharp edges: vertices whose faces meet at an angle get one normal per side.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// What load.crease_deg is without a value of the user. Corners of boxes are sharp; noise of a scan is not,
/// and neither are the edges of a sphere of a few triangles.
inline constexpr float automatic_crease_deg = 60;

/// Which corners of a mesh share a normal. Holds for other positions of the same vertices, too.
struct Creases {
    Array3i F;      ///< faces after the split; empty: nothing is split
    Array3i sides;  ///< for each corner the number of its normal, counted on from those of united vertices
    std::vector<int32_t> rows;      ///< the vertices that those after the mesh's own repeat
    std::vector<int32_t> vertices;  ///< of each side after the united vertices' own, its united vertex
    /// Sides of one surface whose faces are wound against each other: their normals are opposite.
    std::vector<std::pair<int32_t, int32_t>> opposite;

    bool empty() const { return F.empty(); }
};

/// The positions of MeshData::rest_shape; none where there are none for the mesh's vertices and faces.
std::optional<Array3f> rest_positions(const MeshData& mesh);

/// Faces round a vertex share a normal when a chain of common edges joins them across which the face normals
/// differ by at most `crease_angle_deg`. Where two faces run through a common edge in the same direction, one
/// of them is wound the wrong way round: it is taken as turned over, and has the opposite normal, so that
/// each face's normals are on the side that its winding tells. Faces that are folded onto each other share no
/// normal at any angle. Vertices that were split from one (source_vertex) count as one, as for
/// smooth_normals(). A face without area joins what it touches. The angles are those of rest_positions(), if
/// there are any. Does not depend on the number of threads.
Creases find_creases(const MeshData& mesh, float crease_angle_deg);

/// Fills N, and repeats the vertices that need several normals: source_vertex is set then. The repeated ones
/// come last. Returns the row that each vertex had before.
std::vector<int32_t> split_creases(MeshData& mesh, const Creases& creases);

/// The same with those that find_creases() finds.
std::vector<int32_t> split_creases(MeshData& mesh, float crease_angle_deg);

/// Gives a mesh with faces and without normals those that it is drawn with where no setting says otherwise,
/// by the same split. For what is to look the same beside others that have normals, and in files. Tangents
/// stay where nothing is split.
void add_drawn_normals(MeshData& mesh);

/// Gives the vertices whose normal is zero those of split_creases(). The others, which keep theirs, take part
/// in the smooth surfaces, but are not split.
void fill_normals(MeshData& mesh, float crease_angle_deg);

/// split_creases() for a mesh and its children, where they have faces without normals that are not drawn
/// flat.
void split_creases(const Mesh& mesh, float crease_angle_deg);

}  // namespace easypbr
