// Splats as SuperSplat packs them into a PLY file: 16 bytes for each, within the bounds of its chunk of 256.
#pragma once

#include "easypbr/io/mesh/ply/ply_header.h"
#include "easypbr/io/source/source.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// Whether the vertices are packed splats.
bool has_compressed_splats(const PlyHeader& header);

/// Throws FormatError where properties are missing, elements do not fit together or bytes are missing.
MeshData read_compressed_splats(const Source& source, const PlyHeader& header);

}  // namespace easypbr::io
