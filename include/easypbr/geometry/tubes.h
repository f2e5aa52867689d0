// Lines as surfaces: tubes along the edges of a mesh.
#pragma once

#include <optional>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// How a tube ends where its line does.
enum class TubeEnds { round, flat };

struct TubeOptions {
    /// In the mesh's unit, above 0. Automatic: a two-hundredth of the diagonal of the box of the edges.
    std::optional<double> radius = {};
    /// One for each vertex, above 0 for those of edges; or none.
    Array1f radii = {};
    int sides = 12;  ///< around the tube, 3 to 8192
    TubeEnds ends = TubeEnds::round;
};

/// The edges (E) as closed tubes with normals. Edges that follow each other at a vertex of two edges are one
/// tube, mitred there; a line that returns to its first vertex is a ring. Tubes end in half spheres at
/// vertices of three edges or more, at turns of more than 90 degrees, and where the mitre would be longer
/// than half of an edge: together they make a sphere there. The rings of vertices follow the line without
/// twist (parallel transport). Creases are kept where a line turns by more than 30 degrees. Colours, labels,
/// intensities, scalars and texture coordinates of the vertices are carried over. The faces of the mesh come
/// first, with their parts, materials and values; the tubes are a part of the first material. Tubes are drawn
/// smooth: style.flat is unset in the result, and faces that it would draw flat get the normals of faces in
/// place of their own. Points without an edge or a face are left out with a warning. Vertices at the same
/// place that an edge joins count as one, and each pair is joined once. Throws ArgumentError when no edge has
/// a length, for radii that are not above 0, and when both radius and radii are given.
Mesh make_tubes(const Mesh& mesh, const TubeOptions& options = {});

}  // namespace easypbr
