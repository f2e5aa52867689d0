// The long tail of formats (FBX, DAE, 3DS...), by way of assimp's module.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "easypbr/io/mesh_io.h"

namespace easypbr::io {

/// Throws FileError, or FormatError when the file is damaged or the module is absent.
LoadedScene load_assimp(const std::filesystem::path& path);

/// Extensions, in lower case without the dot, that the module reads; empty when it is absent.
std::vector<std::string> assimp_extensions();

}  // namespace easypbr::io
