// Completions of shells, written out from the table of options, so that a shell needs no process to answer.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "easypbr/cli/command.h"
#include "easypbr/cli/command_table.h"

namespace easypbr::cli {
namespace {

struct CompletionOptions {
    const CLI::App* app = nullptr;
    std::string shell;
};

std::string replaced(std::string text, std::string_view what, std::string_view with) {
    for (size_t at = 0; (at = text.find(what, at)) != text.npos; at += with.size())
        text.replace(at, what.size(), with);
    return text;
}

/// Within single quotes of a shell.
std::string quoted(const std::string& text) {
    return replaced(text, "'", "'\\''");
}

std::vector<std::string> with_dashes(const OptionRow& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.short_names) names.push_back("-" + name);
    for (const std::string& name : option.long_names) names.push_back("--" + name);
    return names;
}

std::vector<std::string> command_names(const std::vector<CommandRow>& table) {
    std::vector<std::string> names;
    for (size_t i = 1; i < table.size(); ++i) names.push_back(table[i].name);
    return names;
}

/// The command's options, then those of the program that it has not itself.
std::string option_words(const CommandRow& command, const CommandRow& program) {
    std::vector<std::string> names;
    for (const CommandRow* row : {&command, &program})
        for (const OptionRow& option : row->options)
            for (std::string& name : with_dashes(option))
                if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    return fmt::format("{}", fmt::join(names, " "));
}

/// The words of the first argument, where it is no file.
std::string argument_words(const CommandRow& command) {
    if (command.arguments.empty()) return "";
    return fmt::format("{}", fmt::join(command.arguments.front().choices, " "));
}

/// A pattern of a case for each of the option's names behind `before`, which is a pattern itself.
std::string bash_patterns(const OptionRow& option, const std::string& before) {
    std::vector<std::string> patterns;
    for (const std::string& name : with_dashes(option))
        patterns.push_back(fmt::format("{}' {}'", before, name));
    return fmt::format("{}", fmt::join(patterns, " | "));
}

std::string bash_values(const CommandRow& command, const std::string& before) {
    std::string text;
    if (const std::string words = argument_words(command); !words.empty())
        text += fmt::format("    '{} {}') words='{}' ;;\n", command.name, command.name, quoted(words));
    for (const OptionRow& option : command.options) {
        if (option.placeholder.empty()) continue;
        // Without words bash completes files.
        text += fmt::format("    {}) words='{}'{} ;;\n", bash_patterns(option, before),
                            quoted(fmt::format("{}", fmt::join(option.choices, " "))),
                            option.is_list ? " list=1" : "");
    }
    return text;
}

/// Patterns of the program's options that take a value, which may stand before the command.
std::string bash_value_options(const CommandRow& program) {
    std::vector<std::string> patterns;
    for (const OptionRow& option : program.options)
        if (!option.placeholder.empty())
            for (const std::string& name : with_dashes(option)) patterns.push_back(name);
    return fmt::format("{}", fmt::join(patterns, " | "));
}

std::string bash_completion(const std::vector<CommandRow>& table) {
    const CommandRow& program = table.front();
    std::string values, options;
    for (size_t i = 1; i < table.size(); ++i) {
        values += bash_values(table[i], fmt::format("'{}'", table[i].name));
        options += fmt::format("      {}) words='{}' ;;\n", table[i].name, option_words(table[i], program));
    }
    // The program's own options may follow any command.
    values += bash_values(program, "*");
    return fmt::format(
        R"(# Completion of easypbr for bash, made from its table of options: easypbr completion bash
_easypbr() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} words= list= command= before= i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "${{COMP_WORDS[i]}}" in
    {}) [ "${{COMP_WORDS[i+1]}}" = "=" ] && ((i += 2)) || ((++i)) ;;
    -*) ;;
    *) command=${{COMP_WORDS[i]}}; break ;;
    esac
  done
  case "$command $previous" in
{}    *) case "$command" in
      '') words='{} {}' ;;
      *) [[ $current == -* ]] && case "$command" in
{}    esac ;;
    esac ;;
  esac
  if [ -n "$list" ] && [[ $current == *,* ]]; then before=${{current%,*}},; fi
  [ -n "$words" ] && COMPREPLY=($(compgen -P "$before" -W "$words" -- "${{current#"$before"}}"))
  [ -n "$list" ] && compopt -o nospace 2>/dev/null
  [[ ${{#COMPREPLY[@]}} = 1 && ${{COMPREPLY[0]}} == *= ]] && compopt -o nospace 2>/dev/null
  return 0
}}
complete -o default -F _easypbr easypbr
)",
        bash_value_options(program), values, fmt::join(command_names(table), " "),
        option_words(program, program), options);
}

/// Within the brackets and colons of zsh's _arguments.
std::string zsh_text(const std::string& text) {
    std::string escaped = quoted(text);
    for (const char* special : {"[", "]", ":"})
        escaped = replaced(escaped, special, fmt::format("\\{}", special));
    return escaped;
}

std::string zsh_value(const OptionRow& option) {
    if (option.placeholder.empty()) return "";
    const std::string action =
        !option.choices.empty()
            ? fmt::format("({})", zsh_text(fmt::format("{}", fmt::join(option.choices, " "))))
        : option.takes_file ? "_files"
                            : " ";
    return fmt::format(":{}:{}", zsh_text(option.placeholder), action);
}

std::string zsh_completion(const std::vector<CommandRow>& table) {
    std::string commands, cases;
    for (size_t i = 1; i < table.size(); ++i) {
        const CommandRow& command = table[i];
        commands += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.help));
        cases += fmt::format("    {})\n      _arguments \\\n", command.name);
        for (const OptionRow& option : command.options)
            for (const std::string& name : with_dashes(option))
                cases +=
                    fmt::format("        '*{}[{}]{}' \\\n", name, zsh_text(option.help), zsh_value(option));
        const std::string words = argument_words(command);
        cases += words.empty()
                     ? "        '*:FILE:_files' ;;\n"
                     : fmt::format("        '1:{}:({})' ;;\n",
                                   zsh_text(command.arguments.front().long_names.front()), zsh_text(words));
    }
    return fmt::format(R"(#compdef easypbr
# Completion of easypbr for zsh, made from its table of options: easypbr completion zsh
_easypbr() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
if [ "$funcstack[1]" = _easypbr ]; then _easypbr "$@"; else compdef _easypbr easypbr; fi
)",
                       commands, cases);
}

/// Within single quotes of fish.
std::string fish_text(const std::string& text) {
    return replaced(replaced(text, "\\", "\\\\"), "'", "\\'");
}

std::string fish_completion(const std::vector<CommandRow>& table) {
    std::string text =
        "# Completion of easypbr for fish, made from its table of options: easypbr completion fish\n";
    for (size_t i = 1; i < table.size(); ++i)
        text += fmt::format("complete -c easypbr -n __fish_use_subcommand -f -a {} -d '{}'\n", table[i].name,
                            fish_text(table[i].help));
    for (const CommandRow& command : table)
        if (const std::string words = argument_words(command); !words.empty())
            text += fmt::format("complete -c easypbr -n '__fish_seen_subcommand_from {}' -f -a '{}'\n",
                                command.name, fish_text(words));
    for (size_t i = 0; i < table.size(); ++i)
        for (const OptionRow& option : table[i].options) {
            text += i == 0 ? "complete -c easypbr -n __fish_use_subcommand"
                           : fmt::format("complete -c easypbr -n '__fish_seen_subcommand_from {}'",
                                         table[i].name);
            for (const std::string& name : option.short_names) text += " -s " + name;
            for (const std::string& name : option.long_names) text += " -l " + name;
            if (!option.choices.empty())
                text +=
                    fmt::format(" -x -a '{}'", fish_text(fmt::format("{}", fmt::join(option.choices, " "))));
            else if (!option.placeholder.empty())
                text += option.takes_file ? " -r -F" : " -x";
            text += fmt::format(" -d '{}'\n", fish_text(option.help));
        }
    return text;
}

void declare_completion(CLI::App& command, CompletionOptions& options) {
    options.app = command.get_parent();
    command.add_option("shell", options.shell, "Shell: bash, zsh or fish")->option_text("bash|zsh|fish");
}

int run_completion(const CompletionOptions& options) {
    require(!options.shell.empty(), "completion", "the name of a shell: bash, zsh or fish");
    const std::vector<CommandRow> table = command_table(*options.app);
    if (options.shell == "bash")
        fmt::print("{}", bash_completion(table));
    else if (options.shell == "zsh")
        fmt::print("{}", zsh_completion(table));
    else if (options.shell == "fish")
        fmt::print("{}", fish_completion(table));
    else
        throw UsageError(fmt::format("completion: expected bash, zsh or fish, got '{}'", options.shell));
    return 0;
}

}  // namespace

void add_completion(CLI::App& app, Job& job) {
    set_job<CompletionOptions>(*app.add_subcommand("completion", "Print the completion script of a shell"),
                               job, declare_completion, run_completion);
}

}  // namespace easypbr::cli
