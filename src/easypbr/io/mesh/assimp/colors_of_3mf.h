// Colours of 3MF files (3MF Core Specification, 4.1; Materials and Properties Extension) that assimp loses:
// it has one material for each object.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr::io {

/// What assimp 5.2 does not read of the colours in the XML text of a 3MF model: names for a warning. What is
/// no XML has none.
std::vector<std::string> colors_left_out_of_3mf(std::string_view model);

/// Logs a warning where a 3MF file that assimp has read has such colours. A file whose models cannot be read
/// here gets none. Throws FileError.
void warn_of_colors_of_3mf(const std::filesystem::path& path);

}  // namespace easypbr::io
