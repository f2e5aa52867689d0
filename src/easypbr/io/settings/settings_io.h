// Settings files: every value, chosen and inferred, with the hashes of the files a picture was made from.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "easypbr/scene/light.h"
#include "easypbr/scene/settings.h"

namespace easypbr::io {

/// Content of a settings file (JSON): {"easypbr": 1, "settings": {group: {name: value}}, "lights": {...},
/// "files": {...}}. An inferred value is written as {"auto": value}: reading it back gives the same picture,
/// and "auto" is not lost.
struct SettingsFile {
    Settings settings;
    std::map<std::string, Light> lights;       ///< the scene's own lights
    std::map<std::string, std::string> files;  ///< path -> content hash
};

/// Throws FileError; FormatError with the place for JSON that is no settings file; NameError with the nearest
/// name for an unknown setting.
SettingsFile load_settings(const std::filesystem::path& path);
SettingsFile parse_settings(const std::string& json, const std::string& name);

/// Sets what the text of a settings file says; the rest of `file` stays. Throws as parse_settings().
void apply_settings(const std::string& json, const std::string& name, SettingsFile& file);

/// Throw ArgumentError for a light with values that none can have, and for texts and names that are not
/// UTF-8; FileError.
void save_settings(const SettingsFile& file, const std::filesystem::path& path);
std::string to_json(const SettingsFile& file);

/// Hash of a file's content, as it stands in "files". Throws FileError.
std::string hash_file(const std::filesystem::path& path);

}  // namespace easypbr::io
