#include "easypbr/cli/user_config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/source/json_text.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {
namespace {

using ConfigJson = nlohmann::json;

std::string environment_text(const char* name) {
    const char* const value = std::getenv(name);
    return value ? value : "";
}

/// One entry of the file, for messages.
struct Place {
    const fs::path& path;
    size_t number;

    [[noreturn]] void fail(const std::string& message) const {
        throw FormatError(fmt::format("{}: entry {}: {}", path.string(), number, message));
    }
};

/// As --set takes it.
std::string text_of(const ConfigJson& value, const Field& setting) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean() || value.is_number()) return value.dump();
    std::vector<std::string> parts;
    if (value.is_array())
        for (const ConfigJson& part : value)
            if (part.is_number()) parts.push_back(part.dump());
    if (!value.is_array() || parts.size() != value.size()) reject_value(setting, value.dump());
    return fmt::format("{}", fmt::join(parts, ","));
}

bool fits(const std::string& patterns, const std::string& file) {
    std::istringstream list(patterns);
    for (std::string pattern; std::getline(list, pattern, ',');) {
        const size_t begin = pattern.find_first_not_of(' '), end = pattern.find_last_not_of(' ');
        if (begin == pattern.npos) continue;
        pattern = pattern.substr(begin, end - begin + 1);
        const bool whole = pattern.find('/') != pattern.npos;
        const fs::path path = whole ? fs::absolute(file).lexically_normal() : fs::path(file).filename();
        if (fnmatch(pattern.c_str(), path.c_str(), 0) == 0) return true;
    }
    return false;
}

std::string patterns_of(const ConfigJson& entry, const Place& place) {
    if (!entry.is_object())
        place.fail(R"(expected {"files": "*.pcd", "settings": {"style.point_size": 3}}, got )" +
                   entry.dump());
    for (const auto& [key, value] : entry.items())
        if (key != "files" && key != "settings")
            place.fail(fmt::format("there is no '{}': expected files and settings", key));
    if (!entry.contains("settings") || !entry["settings"].is_object())
        place.fail("expected settings, names with their values");
    if (!entry.contains("files")) return "*";
    if (!entry["files"].is_string()) place.fail("files: expected a pattern such as \"*.pcd, *.las\"");
    return entry["files"].get<std::string>();
}

void apply_entry(const ConfigJson& entry, const std::vector<std::string>& files, const Place& place,
                 Settings& settings) {
    const std::string patterns = patterns_of(entry, place);
    bool counts = false;
    for (const std::string& file : files) counts = counts || fits(patterns, file);
    // What is wrong is told of every entry, not only of those that count today.
    Settings unused = settings;
    for (const auto& [name, value] : entry["settings"].items()) {
        try {
            set_from_text(counts ? settings : unused, name, text_of(value, field(name)));
        } catch (const ArgumentError& error) {
            place.fail(error.what());
        } catch (const NameError& error) {
            place.fail(error.what());
        }
    }
}

ConfigJson parsed(const fs::path& path) {
    return io::parse_json<ConfigJson>(FileBytes(path).text(), path.string());
}

}  // namespace

fs::path user_config_path() {
    if (const char* given = std::getenv("EASYPBR_CONFIG")) return given;
    if (const std::string folder = environment_text("XDG_CONFIG_HOME"); !folder.empty())
        return fs::path(folder) / "easypbr/config.json";
    const std::string home = environment_text("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".config/easypbr/config.json";
}

void apply_user_config(const std::vector<std::string>& files, Settings& settings) {
    const fs::path path = user_config_path();
    std::error_code error;
    if (path.empty() || (std::getenv("EASYPBR_CONFIG") == nullptr && !fs::exists(path, error))) return;
    const ConfigJson entries = parsed(path);
    if (!entries.is_array())
        throw FormatError(
            fmt::format("{}: expected a list of entries with files and settings", path.string()));
    for (size_t i = 0; i < entries.size(); ++i) apply_entry(entries[i], files, {path, i + 1}, settings);
}

}  // namespace easypbr::cli
