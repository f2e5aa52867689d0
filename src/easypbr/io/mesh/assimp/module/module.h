// What the module exports; libeasypbr finds the functions by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace easypbr::io {
struct LoadedScene;
}

extern "C" {
/// Throws FileError, FormatError.
void easypbr_assimp_load(const std::filesystem::path& path, easypbr::io::LoadedScene& out);
void easypbr_assimp_extensions(std::vector<std::string>& out);
}
