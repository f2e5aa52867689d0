// Accessors of glTF: typed, possibly interleaved, normalised and sparse rows of numbers in a buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/rounding.h"

namespace easypbr::io {

/// What the rows of an accessor are.
struct GltfRows {
    size_t count = 0;           ///< 1 to 2^31 - 1
    size_t component_type = 0;  ///< 5120 int8, 5121 uint8, 5122 int16, 5123 uint16, 5125 uint32, 5126 float
    int components = 0;         ///< 1 to 4, or 16
    bool normalized = false;
};

/// Throws FormatError for an accessor that says something else.
GltfRows gltf_rows(const GltfDocument& document, size_t accessor);

/// Rows of floats; normalised integers become 0..1 or -1..1, plain ones (KHR_mesh_quantization) keep their
/// values. `rows`: those that are read, ascending; null: all. Throws FormatError unless the number of
/// components lies in [least, most], all bytes lie in the buffer and the rows are there.
ArrayXf::Dense read_floats(GltfDocument& document, size_t accessor, int least, int most,
                           const std::vector<int32_t>* rows = nullptr);

/// What float32 makes of each column of the rows that read_floats() reads; empty where it has all values of
/// the type. Throws as read_floats() does.
std::vector<RoundingCounts> gltf_rounding(GltfDocument& document, size_t accessor,
                                          const std::vector<int32_t>* rows = nullptr);

/// Vertex indices. Throws FormatError unless it is a scalar of an unsigned integer type.
std::vector<uint32_t> read_indices(GltfDocument& document, size_t accessor);

}  // namespace easypbr::io
