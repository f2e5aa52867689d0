// Buffer views compressed by meshoptimizer (EXT_meshopt_compression).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"

namespace easypbr::io {

inline constexpr const char* ext_meshopt_compression = "EXT_meshopt_compression";

/// The bytes of bufferViews[index], `view`, whose extension `packed` says how they are compressed in `bytes`.
/// Throws FormatError for what is damaged, does not fit the view, or would take more memory than reading may.
std::vector<std::byte> unpack_meshopt(const GltfDocument& document, const Json& view, const Json& packed,
                                      std::span<const std::byte> bytes, size_t index);

}  // namespace easypbr::io
