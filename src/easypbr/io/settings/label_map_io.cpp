#include "easypbr/io/settings/label_map_io.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/settings/label_map_text.h"
#include "easypbr/io/source/json_text.h"
#include "easypbr/scene/label_colors.h"

namespace easypbr::io {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// What a file says.
struct ReadMap {
    std::string name;
    std::vector<ReadClass> classes;
    std::optional<int32_t> unlabelled;
    UnknownLabels unknown = UnknownLabels::refused;
};

[[noreturn]] void fail_label_map(const std::string& file, const std::string& what) {
    throw FormatError(fmt::format("cannot read a label map from {}: {}", file, what));
}

Rgb8 color_of_numbers(const std::vector<double>& numbers) {
    const auto is_code = [](double n) { return n >= 0 && n <= 255 && n == std::floor(n); };
    if (numbers.size() != 3 || !std::ranges::all_of(numbers, is_code))
        throw ArgumentError("expected a colour of three whole numbers from 0 to 255");
    return {uint8_t(numbers[0]), uint8_t(numbers[1]), uint8_t(numbers[2])};
}

int32_t label_of(const OrderedJson& json) {
    if (!json.is_number_integer() || !std::in_range<int32_t>(json.get<int64_t>()))
        throw ArgumentError(fmt::format("expected a label, a whole number, got {}", json.dump()));
    return json.get<int32_t>();
}

ReadClass class_of(const OrderedJson& json) {
    ReadClass result;
    for (const auto& [key, value] : json.items()) {
        if (key == "label")
            result.label = label_of(value);
        else if (key == "name")
            result.name = value.get<std::string>();
        else if (key == "color" && value.is_string())
            result.color = to_rgb8(parse_color(value.get<std::string>()));
        else if (key == "color")
            result.color = color_of_numbers(value.get<std::vector<double>>());
        else
            throw ArgumentError(fmt::format("unknown key '{}' (expected label, name, color)", key));
    }
    if (!json.contains("label")) throw ArgumentError("a class has no \"label\"");
    return result;
}

UnknownLabels unknown_of(const std::string& text) {
    if (text == "refused") return UnknownLabels::refused;
    if (text == "unlabelled") return UnknownLabels::unlabelled;
    throw ArgumentError(fmt::format("\"unknown\": expected refused or unlabelled, got '{}'", text));
}

ReadMap read_json(std::string_view text, const std::string& file) {
    const OrderedJson root = parse_json<OrderedJson>(text, file);
    ReadMap map;
    for (const auto& [key, value] : root.items()) {
        if (key == "name")
            map.name = value.get<std::string>();
        else if (key == "unlabelled")
            map.unlabelled = label_of(value);
        else if (key == "unknown")
            map.unknown = unknown_of(value.get<std::string>());
        else if (key == "classes")
            for (const OrderedJson& own : value) map.classes.push_back(class_of(own));
        else
            throw ArgumentError(
                fmt::format("unknown key '{}' (expected name, unlabelled, unknown, classes)", key));
    }
    return map;
}

ReadMap read_yaml(std::string_view text) {
    const YAML::Node root = YAML::Load(std::string(text));
    ReadMap map;
    if (!root.IsMap() || !root["labels"])
        throw ArgumentError("expected 'labels:' with a name for each label");
    for (const auto& entry : root["labels"])
        map.classes.push_back({entry.first.as<int32_t>(), entry.second.as<std::string>(), {}});
    if (!root["color_map"]) return map;
    for (ReadClass& own : map.classes) {
        const YAML::Node color = root["color_map"][own.label];
        if (!color) continue;
        auto numbers = color.as<std::vector<double>>();
        std::ranges::reverse(numbers);
        own.color = color_of_numbers(numbers);
    }
    return map;
}

bool means_unlabelled(const std::string& name) {
    return name == "unlabeled" || name == "unlabelled" || name == "unannotated";
}

LabelMap finished(ReadMap read) {
    std::vector<LabelClass> classes;
    for (ReadClass& own : read.classes) {
        if (!read.unlabelled && means_unlabelled(own.name)) read.unlabelled = own.label;
        const Rgb8 color = own.color ? *own.color : GeneratedColors(own.label).color_of(own.label);
        classes.push_back({own.label, std::move(own.name), color});
    }
    return LabelMap(read.name, std::move(classes), read.unlabelled, read.unknown);
}

bool is_yaml(const fs::path& path) {
    const std::string extension = extension_of(path);
    return extension == "yaml" || extension == "yml";
}

ReadMap read(const fs::path& path, std::string_view text) {
    if (extension_of(path) == "json") return read_json(text, path.string());
    if (is_yaml(path)) return read_yaml(text);
    return {{}, parse_label_text(text, path.string()), {}, UnknownLabels::refused};
}

std::string label_map_json(const LabelMap& map) {
    OrderedJson root;
    root["name"] = map.name();
    if (map.unlabelled()) root["unlabelled"] = *map.unlabelled();
    root["unknown"] = map.unknown() == UnknownLabels::refused ? "refused" : "unlabelled";
    root["classes"] = OrderedJson::array();
    for (const LabelClass& own : map.classes()) {
        const Vec3 color = Vec3(own.color[0], own.color[1], own.color[2]) / 255.0f;
        root["classes"].push_back({{"label", own.label}, {"name", own.name}, {"color", to_hex(color)}});
    }
    return root.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

bool is_built_in(const std::string& name) {
    const auto& names = built_in_label_map_names();
    return std::ranges::find(names, name) != names.end();
}

bool is_label_map_file(const fs::path& path) {
    std::error_code ignored;
    return path.has_extension() || path.has_parent_path() || fs::exists(path, ignored);
}

}  // namespace

LabelMap load_label_map(const fs::path& path) {
    return parse_label_map(FileBytes(path).text(), path);
}

LabelMap parse_label_map(std::string_view text, const fs::path& path) {
    try {
        ReadMap map = read(path, text);
        if (map.name.empty()) map.name = path.stem().string();
        return finished(std::move(map));
    } catch (const FormatError&) {
        throw;
    } catch (const std::exception& error) {  // of the parsers, of colours, of LabelMap itself
        fail_label_map(path.string(), error.what());
    }
}

std::string format_label_map(const LabelMap& map, const fs::path& path) {
    if (is_yaml(path))
        throw FormatError(
            fmt::format("cannot write {}: label maps are written as JSON or text", path.string()));
    return extension_of(path) == "json" ? label_map_json(map) : to_label_text(map);
}

void save_label_map(const LabelMap& map, const fs::path& path) {
    write_file(path, format_label_map(map, path));
}

void check_label_map(const std::string& name_or_path) {
    if (!is_label_map_file(name_or_path)) built_in_label_map(name_or_path);
}

std::shared_ptr<const LabelMap> find_label_map(const std::string& name_or_path) {
    if (is_built_in(name_or_path) || !is_label_map_file(name_or_path))
        return built_in_label_map(name_or_path);  // its error names the nearest one
    return std::make_shared<const LabelMap>(load_label_map(name_or_path));
}

}  // namespace easypbr::io
