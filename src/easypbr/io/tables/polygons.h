// Polygons as files have them, and the way from them to triangles.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/io/source/source.h"
#include "easypbr/scene/corner_split.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// Rows of numbers, all of `width` numbers, or (when `first` is not empty) of different lengths.
template <class T>
struct List {
    size_t rows = 0;
    size_t width = 0;
    std::vector<uint32_t> first;  ///< rows + 1 entries; empty when all rows are equally long
    Eigen::Matrix<T, Eigen::Dynamic, 1> values;

    size_t begin_of(size_t row) const { return first.empty() ? row * width : first[row]; }
    size_t size_of(size_t row) const { return first.empty() ? width : first[row + 1] - first[row]; }
    size_t value_count() const { return size_t(values.size()); }
};

/// A row of vertex indices per polygon.
using Polygons = List<int32_t>;

/// Throws FormatError unless all indices are in [0, count). The message counts from `base`, as the file does.
void check_indices(const Source& source, std::span<const int32_t> indices, size_t count,
                   std::string_view what, int base = 0);

/// Throws FormatError, naming the first one, unless all positions are finite.
void check_positions(const Source& source, const Array3f::Dense& V);

/// Where the search for the ears of a polygon ends: looks at the tree of its corners, for each of them. What
/// does not fold back on itself all over takes some tens, a million spikes of random lengths take 500.
inline constexpr uint64_t most_looks = 1 << 11;

/// Writes the size - 2 triangles of a polygon of at least three corners, as triangulate() cuts it. Returns
/// false where the search for ears ended early: triangles may overlap, though their signed areas add up to
/// the polygon's. Throws Interrupted.
bool cut_polygon(const Array3f& V, const int32_t* polygon, size_t size, int32_t* out,
                 uint64_t looks = most_looks);

/// Fills F and source_face of a mesh whose V is set. A polygon of n corners gives n - 2 triangles: a fan
/// where all of its triangles lie inside, else a concave quad is cut along its other diagonal where only that
/// one lies inside, and the ears of larger polygons are cut off; a warning counts those whose search for ears
/// ended early. Polygons with less than three corners give none. Throws Interrupted.
void triangulate(Polygons&& polygons, MeshData& mesh, uint64_t looks = most_looks);

/// Triangles of strips with indices in the order of the winding; -1 starts a new strip, degenerate triangles
/// are left out.
std::vector<int32_t> triangles_of_strips(const Polygons& strips);

/// Makes one vertex of each different pair of a vertex and a colour of the polygons that use it, and fills
/// the mesh's C. `C` has a row of three or four parts in 0 .. 1 for each polygon.
CornerSplit color_vertices_by_faces(const ArrayXf::Dense& C, Polygons& polygons, MeshData& mesh);

/// Sorts the triangles by material (stable) and fills `parts`: one for each material that is used.
/// `material_of_polygon` has an entry for each polygon of the file.
void assign_materials(std::span<const int32_t> material_of_polygon, MeshData& mesh);

}  // namespace easypbr::io
