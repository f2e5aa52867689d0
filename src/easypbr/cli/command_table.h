// The commands and options of the command line as a table: what completions and manual pages are made from.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace easypbr::cli {

struct OptionRow {
    std::vector<std::string> short_names, long_names;  ///< without dashes
    std::string placeholder;                           ///< of its value; empty: it takes none
    std::string help;
    std::vector<std::string> choices;  ///< of its value; those that end in "=" go on
    bool takes_file = false;
    bool is_list = false;  ///< several of the choices, separated by commas
};

struct CommandRow {
    std::string name, help;
    std::vector<OptionRow> options;
    std::vector<OptionRow> arguments;  ///< positional: their only long name is the placeholder
};

/// The program's own options, under its name, and then each command.
std::vector<CommandRow> command_table(const CLI::App& app);

}  // namespace easypbr::cli
