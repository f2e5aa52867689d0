// Manual pages, from the table of options.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "easypbr/cli/command.h"
#include "easypbr/cli/command_table.h"
#include "easypbr/core/ascii.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"

namespace easypbr::cli {
namespace {

struct ManOptions {
    const CLI::App* app = nullptr;
    std::string command, folder;
};

/// As troff prints it unchanged.
std::string troff(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '\\')
            result += "\\e";
        else if (c == '-')
            result += "\\-";
        else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n'))
            result += fmt::format("\\&{}", c);
        else
            result += c;
    }
    return result;
}

std::string page_name(const CommandRow& command, const CommandRow& program) {
    return &command == &program ? program.name : program.name + "-" + command.name;
}

std::string option_text(const OptionRow& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.short_names) names.push_back("\\fB" + troff("-" + name) + "\\fR");
    for (const std::string& name : option.long_names) names.push_back("\\fB" + troff("--" + name) + "\\fR");
    std::string text = fmt::format(".TP\n{}", fmt::join(names, ", "));
    if (!option.placeholder.empty()) text += fmt::format(" \\fI{}\\fR", troff(option.placeholder));
    text += fmt::format("\n{}", troff(option.help));
    // Lists of all settings stand in the reference.
    const bool goes_on = !option.choices.empty() && option.choices.front().ends_with('=');
    if (!option.choices.empty() && !goes_on)
        text += fmt::format("\n.br\nOne of {}.", troff(fmt::format("{}", fmt::join(option.choices, ", "))));
    return text + "\n";
}

std::string synopsis(const CommandRow& command, const CommandRow& program) {
    if (&command == &program)
        return fmt::format(".B {}\n.I COMMAND\n[\\fIOPTION\\fR]...\n", troff(program.name));
    std::string text =
        fmt::format(".B {} {}\n[\\fIOPTION\\fR]...\n", troff(program.name), troff(command.name));
    for (const OptionRow& argument : command.arguments)
        text += fmt::format(".I {}\n", troff(argument.long_names.front()));
    return text;
}

std::string commands_section(const std::vector<CommandRow>& table) {
    std::string text = ".SH COMMANDS\n";
    for (size_t i = 1; i < table.size(); ++i)
        text += fmt::format(".TP\n\\fB{}\\fR\n{}; see {}(1)\n", troff(table[i].name), troff(table[i].help),
                            troff(page_name(table[i], table.front())));
    return text;
}

std::string page_of(const CommandRow& command, const std::vector<CommandRow>& table) {
    const CommandRow& program = table.front();
    const std::string name = page_name(command, program);
    std::string text = fmt::format(
        ".TH \"{}\" 1 \"\" \"EasyPBR {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}",
        troff(ascii::to_upper(name)), EASYPBR_VERSION, troff(name), troff(command.help),
        synopsis(command, program));
    if (&command == &program) text += commands_section(table);
    if (!command.arguments.empty()) {
        text += ".SH ARGUMENTS\n";
        for (const OptionRow& argument : command.arguments)
            text += fmt::format(".TP\n\\fI{}\\fR\n{}\n", troff(argument.long_names.front()),
                                troff(argument.help));
    }
    text += ".SH OPTIONS\n";
    for (const OptionRow& option : command.options) text += option_text(option);
    return text + ".SH EXIT STATUS\n0: done. 1: the job failed. 2: the command is wrong.\n";
}

void declare_man(CLI::App& command, ManOptions& options) {
    options.app = command.get_parent();
    command.add_option("command", options.command, "Command to describe; default: the program itself")
        ->option_text("COMMAND");
    command
        .add_option("-o,--output", options.folder, "Write the pages of all commands to this folder instead")
        ->option_text("FOLDER");
}

void write_pages(const std::vector<CommandRow>& table, const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    for (const CommandRow& command : table)
        write_file(folder / (page_name(command, table.front()) + ".1"), page_of(command, table));
}

int run_man(const ManOptions& options) {
    const std::vector<CommandRow> table = command_table(*options.app);
    if (!options.folder.empty()) {
        write_pages(table, options.folder);
        return 0;
    }
    std::vector<std::string> names;
    for (const CommandRow& command : table) {
        if (command.name == options.command || (options.command.empty() && &command == &table.front())) {
            fmt::print("{}", page_of(command, table));
            return 0;
        }
        names.push_back(command.name);
    }
    throw UsageError(fmt::format("man: there is no command '{}'{}; expected one of {}", options.command,
                                 did_you_mean(options.command, names), fmt::join(names, ", ")));
}

}  // namespace

void add_man(CLI::App& app, Job& job) {
    set_job<ManOptions>(*app.add_subcommand("man", "Print a manual page, or write all of them"), job,
                        declare_man, run_man);
}

}  // namespace easypbr::cli
