#include "easypbr/io/settings/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"

namespace easypbr::io {
namespace {

struct BuiltInPreset {
    std::string_view file, text;
};

constexpr BuiltInPreset built_in_presets[] = {
#include "easypbr_presets.inc"
};

bool is_preset_file(const std::string& name) {
    std::error_code ignored;
    return !fs::path(name).extension().empty() || fs::exists(name, ignored);
}

}  // namespace

const std::vector<std::string>& preset_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const BuiltInPreset& preset : built_in_presets)
            all.push_back(fs::path(preset.file).stem().string());
        return all;
    }();
    return names;
}

void check_preset(const std::string& name_or_path) {
    const bool is_known = std::ranges::find(preset_names(), name_or_path) != preset_names().end();
    if (!is_known && !is_preset_file(name_or_path))
        throw NameError(fmt::format("there is no preset '{}'{}; expected one of {}, or a settings file",
                                    name_or_path, did_you_mean(name_or_path, preset_names()),
                                    fmt::join(preset_names(), ", ")));
}

void apply_preset(const std::string& name_or_path, SettingsFile& file) {
    const auto known = std::ranges::find(preset_names(), name_or_path);
    if (known != preset_names().end()) {
        const BuiltInPreset& preset = built_in_presets[known - preset_names().begin()];
        return apply_settings(std::string(preset.text), "preset " + name_or_path, file);
    }
    check_preset(name_or_path);
    const FileBytes bytes(name_or_path);
    apply_settings(std::string(bytes.text()), name_or_path, file);
}

}  // namespace easypbr::io
