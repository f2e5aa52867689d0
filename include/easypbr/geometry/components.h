// The connected pieces of a mesh.
#pragma once

#include <vector>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// For each vertex the number of its piece, from 0 by first vertex. Vertices are connected by faces, by edges
/// and by being at the same place, so that seams and hard edges do not cut; one that nothing uses is a piece
/// of its own.
Array1i vertex_components(const Mesh& mesh);

/// For each face the number of its piece, from 0 by first face.
Array1i face_components(const Mesh& mesh);

/// Each piece as a mesh of its own with all that belongs to it, by first vertex; vertices that no face and
/// edge uses are left out. Throws ArgumentError when there are neither faces nor edges: nothing connects a
/// cloud.
std::vector<Mesh> split(const Mesh& mesh);

}  // namespace easypbr
