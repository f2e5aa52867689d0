// What a command writes: no file twice, and none that it reads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr::cli {

/// A path and the option that names it.
struct NamedPath {
    std::string option;
    std::filesystem::path path;
};

/// Compares files, whatever their paths are written as; devices and pipes take anything. Throws UsageError.
void check_paths(std::string_view command, const std::vector<NamedPath>& written,
                 const std::vector<NamedPath>& read);

}  // namespace easypbr::cli
