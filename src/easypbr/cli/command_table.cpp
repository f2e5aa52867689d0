#include "easypbr/cli/command_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "easypbr/cli/command.h"
#include "easypbr/cli/parse_errors.h"
#include "easypbr/cli/render_options.h"
#include "easypbr/cli/truth_layers.h"
#include "easypbr/core/ascii.h"
#include "easypbr/io/settings/presets.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/label_map.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::cli {
namespace {

std::vector<std::string> settings_below(const std::string& prefix) {
    std::vector<std::string> names;
    for (const Field& field : fields())
        if (field.name.starts_with(prefix)) names.push_back(field.name.substr(prefix.size()) + "=");
    return names;
}

std::vector<std::string> textures() {
    std::vector<std::string> names;
    for (const MaterialTexture& row : replaceable_textures()) names.push_back(std::string(row.name) + "=");
    return names;
}

/// "stop|skip" of a placeholder whose parts are all words.
std::vector<std::string> placeholder_values(const std::string& placeholder) {
    std::vector<std::string> values;
    std::istringstream list(placeholder);
    for (std::string value; std::getline(list, value, '|');)
        if (std::ranges::all_of(value, ascii::is_lower)) values.push_back(value);
    return values;
}

std::vector<std::string> choices_of(const std::string& name, const CLI::Option& option) {
    if (name == "set") return settings_below("");
    if (name == "style") return settings_below("style.");
    if (name == "texture") return textures();
    if (name == "layers") return writable_layers();
    if (name == "preset") return io::preset_names();
    if (name == "writers") return dataset_writers();
    if (name == "label-map") return built_in_label_map_names();
    if (const std::string setting = setting_of_shorthand("--" + name); !setting.empty())
        if (const Field& known = field(setting); !known.choices.empty()) return known.choices;
    if (std::vector<std::string> values = listed_values(option); !values.empty()) return values;
    return placeholder_values(option.get_option_text());
}

OptionRow row_of(const CLI::Option& option) {
    OptionRow row;
    row.short_names = option.get_snames();
    row.long_names = option.get_lnames();
    row.help = option.get_description();
    const bool is_flag = option.get_items_expected_max() == 0;
    const std::string name = row.long_names.empty() ? option.get_name() : row.long_names.front();
    if (!is_flag) {
        row.placeholder =
            option.get_option_text().empty() ? option.get_type_name() : option.get_option_text();
        row.choices = choices_of(name, option);
        // The type that CLI11 names stands before its values.
        if (const size_t end = row.placeholder.find(':'); end != row.placeholder.npos)
            row.placeholder = row.placeholder.substr(0, end);
    }
    row.is_list = !row.choices.empty() && row.placeholder.find(',') != row.placeholder.npos;
    row.takes_file = row.placeholder.find("FILE") != row.placeholder.npos ||
                     row.placeholder.find("FOLDER") != row.placeholder.npos || name == "texture";
    return row;
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

CommandRow row_of(const CLI::App& command) {
    CommandRow row{command.get_name(), command.get_description(), {}, {}};
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_positional()) {
            row.options.push_back(row_of(*option));
            continue;
        }
        OptionRow argument = row_of(*option);
        argument.long_names = {option->get_option_text().empty() ? option->get_name(true)
                                                                 : option->get_option_text()};
        if (argument.long_names.front() == "COMMAND")
            argument.choices = names_of_commands(*command.get_parent());
        argument.takes_file = argument.choices.empty();
        row.arguments.push_back(argument);
    }
    return row;
}

}  // namespace

std::vector<CommandRow> command_table(const CLI::App& app) {
    std::vector<CommandRow> rows = {row_of(app)};
    for (const CLI::App* command : app.get_subcommands({})) rows.push_back(row_of(*command));
    return rows;
}

}  // namespace easypbr::cli
