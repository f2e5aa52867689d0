// Scenes from bytes that were read from a file or a pipe.
#pragma once

#include "easypbr/core/file.h"
#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::io {

/// load_scene() of the bytes. Throws as that does, and FileError when they could not be read to their end
/// (FileBytes::check). Those of a large file do not all count as used memory.
LoadedScene load_scene(const FileBytes& bytes, const fs::path& name, const LoadOptions& options);

}  // namespace easypbr::io
