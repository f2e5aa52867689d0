// Label maps from text, without files.
#pragma once

#include <filesystem>
#include <string_view>

#include "easypbr/scene/label_map.h"

namespace easypbr::io {

/// A class whose colour may be missing.
struct ReadClass {
    int32_t label = 0;
    std::string name;
    std::optional<Rgb8> color;
};

/// See load_label_map(). `file` names the text in messages. Throws FormatError with the line.
std::vector<ReadClass> parse_label_text(std::string_view text, const std::string& file);

/// "LABEL NAME R G B" for each class; names with blanks are quoted.
std::string to_label_text(const LabelMap& map);

/// What save_label_map() writes into a file of this name. Throws FormatError for YAML.
std::string format_label_map(const LabelMap& map, const std::filesystem::path& path);

/// The content of a label map's file, of the format that the path's extension names. Throws as
/// load_label_map() does for what is in a file.
LabelMap parse_label_map(std::string_view text, const std::filesystem::path& path);

}  // namespace easypbr::io
