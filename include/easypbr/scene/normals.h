// Normals and tangents from geometry; parallel and deterministic.
#pragma once

#include <vector>

#include "easypbr/scene/array.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// Unit vertex normals (n x 3): the sum of the adjacent faces' normals weighted by area times the corner's
/// angle. Faces without area count nothing; a vertex without any gets (0, 0, 1). The result does not depend
/// on the number of threads, and scaling V by a power of two leaves it the same bit for bit. Throws
/// ArgumentError when a vertex index is out of range, as the functions below do.
Array3f vertex_normals(const Array3f& V, const Array3i& F);

/// vertex_normals() of a mesh: vertices that were split from one (source_vertex), as at seams of texture
/// coordinates, count as one and get the same normal. Throws ArgumentError for arrays that validate() refuses
/// by their shapes, and for a source below 0.
Array3f smooth_normals(const MeshData& mesh);

/// Unit normals of faces (m x 3); (0, 0, 1) where a face has no area.
Array3f face_normals(const Array3f& V, const Array3i& F);

/// Tangents per face corner (3m x 4): unit tangent in xyz, sign of the bitangent in w (bitangent = w cross(n,
/// t)), by the rule of MikkTSpace (Mikkelsen 2008): corners with equal position, normal and uv that are
/// joined by faces of one uv orientation share one angle-weighted tangent. Never NaN: degenerate uv give a
/// tangent perpendicular to the normal. `N` and `UV` have a row for each vertex.
ArrayXf corner_tangents(const Array3f& V, const Array3f& N, const Array2f& UV, const Array3i& F);

/// Tangents per face corner as they are drawn: those that the mesh has (MeshData::uv_tangents),
/// corner_tangents() elsewhere. `N` has a row for each vertex. Meshes without texture coordinates must have
/// all.
ArrayXf mesh_tangents(const MeshData& mesh, const Array3f& N);

/// Whether MeshData::uv_tangents has a tangent for each vertex.
bool has_all_tangents(const MeshData& mesh);

}  // namespace easypbr
