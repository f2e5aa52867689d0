// A user's own defaults, by the names of files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace easypbr {
struct Settings;
}

namespace easypbr::cli {

/// The file of a user's defaults: $EASYPBR_CONFIG, else easypbr/config.json in $XDG_CONFIG_HOME or ~/.config.
/// Empty: EASYPBR_CONFIG is, or there is no home.
std::filesystem::path user_config_path();

/// Sets what the user's file says of these mesh files, entry by entry: a list of
/// {"files": "*.pcd", "settings": {"style.point_size": 3}}. An entry counts if one of the files fits its
/// pattern (of the shell; several are separated by commas; without "/" it is that of the file's name). Does
/// nothing without a user's file. Throws FileError; FormatError that names the file and what is wrong.
void apply_user_config(const std::vector<std::string>& files, Settings& settings);

}  // namespace easypbr::cli
