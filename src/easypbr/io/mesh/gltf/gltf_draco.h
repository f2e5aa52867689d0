// Primitives compressed by Draco (KHR_draco_mesh_compression).
#pragma once

#include <optional>
#include <string>

#include "easypbr/io/mesh/gltf/gltf_document.h"

namespace easypbr::io {

inline constexpr const char* khr_draco = "KHR_draco_mesh_compression";

/// Why Draco's module cannot be used; empty: it can.
const std::string& draco_problem();

/// Gives the document the rows of a primitive's accessors when they are compressed, and returns the buffer
/// view that they were in; takes back those of the primitive before. `owner` stands in messages
/// ("meshes[0]"). The work is done by a module of its own (libeasypbr_draco.so), loaded when it is first
/// needed. Throws FormatError for damaged data, and when the module is missing.
std::optional<size_t> unpack_draco(GltfDocument& document, const Json& primitive, const std::string& owner);

}  // namespace easypbr::io
