// Label maps as files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "easypbr/scene/label_map.h"

namespace easypbr::io {

/// Reads a label map, by the extension:
/// - JSON: {"name": "...", "unlabelled": 0, "unknown": "unlabelled", "classes": [{"label": 0, "name": "road",
///   "color": "#804080"}, ...]}; all but "classes" and "label" may be missing.
/// - YAML: {labels: {0: road}, color_map: {0: [64, 128, 80]}} as in SemanticKITTI's configuration, blue
/// first.
/// - other text: a line "LABEL NAME R G B [A]" or "LABEL R G B ... NAME" for each class (FreeSurfer,
/// ITK-SNAP,
///   CSV with or without a header), colours 0 to 255 or missing; or one name per line for labels 0, 1, 2, ...
/// Classes without a colour get a generated one. A class called "unlabeled",
/// "unlabelled" or "unannotated" is the unlabelled one. The map's name is the file's stem unless it says
/// another.
/// Throws FileError; FormatError with the place.
LabelMap load_label_map(const std::filesystem::path& path);

/// Writes JSON, or the first text form for any other extension but YAML's. Throws FileError, FormatError.
void save_label_map(const LabelMap& map, const std::filesystem::path& path);

/// Throws NameError with the nearest name for what is neither a built-in map nor the name of a file.
void check_label_map(const std::string& name_or_path);

/// A built-in map by its name, else a file. Throws as load_label_map() does, NameError with the nearest name
/// for what is neither.
std::shared_ptr<const LabelMap> find_label_map(const std::string& name_or_path);

}  // namespace easypbr::io
