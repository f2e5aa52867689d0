// Presets: settings files, built in or written by people, that say how a picture looks.
#pragma once

#include <string>
#include <vector>

#include "easypbr/io/settings/settings_io.h"

namespace easypbr::io {

/// Names of the built-in presets.
const std::vector<std::string>& preset_names();

/// Throws NameError with the nearest name for what is neither a built-in preset nor the name of a file.
void check_preset(const std::string& name_or_path);

/// Sets what a preset says, a built-in one's name or a settings file; the rest of `file` stays. Throws
/// FileError, FormatError; NameError with the nearest name for what is neither, and for an unknown setting.
void apply_preset(const std::string& name_or_path, SettingsFile& file);

}  // namespace easypbr::io
