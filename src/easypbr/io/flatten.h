// A mesh with its descendants as one set of arrays, for formats without a hierarchy.
#pragma once

#include "easypbr/scene/mesh.h"

namespace easypbr::io {

/// All nodes in one, in the frame of the root's parent. A single node with an identity pose keeps its arrays.
/// An attribute that only some nodes have is filled in for the others: white colours, computed normals, 0 for
/// the rest.
MeshData flatten(const Mesh& mesh);

}  // namespace easypbr::io
