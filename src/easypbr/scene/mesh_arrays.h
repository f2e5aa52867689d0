// The arrays of a mesh as a whole.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// The rows of an array that the indices name, in their order; of an empty array an empty one.
template <class Scalar, int Cols>
Array<Scalar, Cols> rows_of(const Array<Scalar, Cols>& array, std::span<const int32_t> rows) {
    if (array.empty()) return {};
    typename Array<Scalar, Cols>::Dense chosen(Eigen::Index(rows.size()), array.cols());
    parallel_for(rows.size(), 1 << 15, [&](size_t i) { chosen.row(Eigen::Index(i)) = array.row(rows[i]); });
    return Array<Scalar, Cols>(std::move(chosen));
}

/// The same for all that splats have beside their means.
SplatArrays rows_of(const SplatArrays& splats, std::span<const int32_t> rows);

/// Throws ArgumentError that names the first row of F with an index that is no vertex's.
void require_faces(const Array3i& F, Eigen::Index vertices);

/// Throws ArgumentError that names the first number below 0 in source_face or source_vertex.
void require_sources(const char* name, const Array1i& sources, const char* of);
/// Throws ArgumentError unless a pose is finite and its last row 0 0 0 1.
void require_pose(const char* name, const Eigen::Affine3d& T);

/// Numbers from 0 on that are equal where the given ones are, in the same order, and below `limit` or the
/// number of rows: the given ones where these are below it.
Array1i numbers_below(int64_t limit, const Array1i& numbers);
/// Throws ArgumentError that names an array with another shape than validate() takes.
void require_shapes(const MeshData& mesh);

/// Replaces all that a mesh holds for each vertex by the rows that the indices name. Labels and scalars must
/// be those of vertices.
void choose_vertex_rows(MeshData& mesh, std::span<const int32_t> rows);

/// The same, and sets source_vertex, which goes on from the one that there is.
void repeat_vertices(std::span<const int32_t> rows, MeshData& mesh);

/// Where there are as many faces as vertices, repeats the last vertex, which no face uses then: what has a
/// value for each face would pass for values of the vertices. Labels and scalars must be those of vertices.
void tell_faces_from_vertices(MeshData& mesh);

/// Labels and scalars of faces, out of a mesh while its vertices change.
struct FaceValues {
    Array1i L;
    std::vector<Array1f> scalars;  ///< one for each of the mesh; empty for those of vertices

    FaceValues() = default;
    /// Takes them out of the mesh.
    explicit FaceValues(MeshData& mesh);
    /// Puts them back; where they would pass for values of vertices, tell_faces_from_vertices() comes before.
    void put_back(MeshData& mesh) const;
};

/// Gives a mesh the arrays, parts and sources of another; its name, materials, style, pose and children stay.
void replace_arrays(MeshData& mesh, const MeshData& arrays);

/// The revisions of all arrays that replace_arrays() gives a mesh, in one order.
std::vector<uint64_t> array_revisions(const MeshData& mesh);

/// A mesh without arrays, parts and sources, and otherwise the same.
MeshData without_arrays(const MeshData& mesh);

/// Empties MeshData::uv_tangents where they are still those of `before`, but not what they belong to.
void drop_stale_tangents(MeshData& edited, const MeshData& before);

}  // namespace easypbr
