// The long tail of mesh formats, through assimp: a module of its own that is loaded when it is first needed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace easypbr::io {

struct LoadedScene;

/// Reads any format that assimp knows. Throws FileError; FormatError when assimp refuses the file, or when
/// its module (libeasypbr_assimp.so, searched beside libeasypbr.so and then where the system searches) is not
/// there.
LoadedScene load_assimp(const std::filesystem::path& path);

/// Extensions that assimp reads, sorted; empty without its module.
std::vector<std::string> assimp_extensions();

}  // namespace easypbr::io
