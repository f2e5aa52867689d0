// Points as PCD, text and NumPy arrays. Faces and edges go into NPZ only.
#pragma once

#include <string>

#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// PCD, binary: colours packed as "rgb" (or "rgba").
std::string encode_pcd(const MeshData& mesh);

/// Rows of text. Names of the columns stand in the first line, behind '#' unless commas separate them.
std::string encode_xyz(const MeshData& mesh, char delimiter);

/// A structured array: np.load(path)["x"].
std::string encode_npy(const MeshData& mesh);

/// An archive of V, N, C, UV, T, B, F, E, L, I, offset and scalars, as far as the mesh has them.
std::string encode_npz(const MeshData& mesh);

}  // namespace easypbr::io
