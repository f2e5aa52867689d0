// Programs that the user has installed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace easypbr {

/// The absolute path of a program of this name that can be run. Of PATH only absolute folders count: the
/// current one is not trusted.
std::optional<std::filesystem::path> program_in_path(const std::string& name);

}  // namespace easypbr
