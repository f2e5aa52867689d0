// Accessors of glTF: typed, possibly interleaved, normalised and sparse rows of numbers in a buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/array.h"

namespace easypbr::io {

/// Rows of floats; normalised integers become 0..1 or -1..1, plain ones (KHR_mesh_quantization) keep their
/// values. Throws FormatError unless the number of components lies in [least, most] and all bytes lie in the
/// buffer.
ArrayXf::Dense read_floats(GltfDocument& document, size_t accessor, int least, int most);

/// Vertex indices. Throws FormatError unless it is a scalar of an unsigned integer type.
std::vector<uint32_t> read_indices(GltfDocument& document, size_t accessor);

}  // namespace easypbr::io
