// Completions of shells, written out from the table of options, so that a shell needs no process to answer.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

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

bool has_option(const CommandRow& command, const OptionRow& wanted) {
    return std::ranges::any_of(command.options, [&](const OptionRow& option) {
        return option.long_names == wanted.long_names && option.short_names == wanted.short_names;
    });
}

/// What may follow a command: its options, then those of the program that it has not itself.
std::vector<OptionRow> options_after(const CommandRow& command, const CommandRow& program) {
    std::vector<OptionRow> options = command.options;
    std::ranges::copy_if(program.options, std::back_inserter(options),
                         [&](const OptionRow& option) { return !has_option(command, option); });
    return options;
}

std::string joined(const std::vector<std::string>& words, std::string_view separator = " ") {
    return fmt::format("{}", fmt::join(words, separator));
}

std::string option_words(const std::vector<OptionRow>& options) {
    std::vector<std::string> names;
    for (const OptionRow& option : options) std::ranges::copy(with_dashes(option), std::back_inserter(names));
    return joined(names);
}

/// The program's options that take a value, which may stand before the command.
std::vector<std::string> value_options(const CommandRow& program) {
    std::vector<std::string> names;
    for (const OptionRow& option : program.options)
        if (!option.placeholder.empty()) std::ranges::copy(with_dashes(option), std::back_inserter(names));
    return names;
}

/// The words of the first argument, where it is no file.
std::string argument_words(const CommandRow& command) {
    if (command.arguments.empty()) return "";
    return joined(command.arguments.front().choices);
}

/// A pattern of a case for each of the option's names behind `before`, which is a pattern itself.
std::string bash_patterns(const OptionRow& option, const std::string& before) {
    std::vector<std::string> patterns;
    for (const std::string& name : with_dashes(option))
        patterns.push_back(fmt::format("{}' {}'", before, name));
    return joined(patterns, " | ");
}

std::string bash_values(const CommandRow& command, const std::string& before) {
    std::string text;
    if (const std::string words = argument_words(command); !words.empty())
        text += fmt::format("    '{} {}') words='{}' ;;\n", command.name, command.name, quoted(words));
    for (const OptionRow& option : command.options) {
        if (option.placeholder.empty()) continue;
        // Without words bash completes files.
        text += fmt::format("    {}) words='{}'{} ;;\n", bash_patterns(option, before),
                            quoted(joined(option.choices)), option.is_list ? " list=1" : "");
    }
    return text;
}

std::string bash_completion(const std::vector<CommandRow>& table) {
    const CommandRow& program = table.front();
    std::string values, options;
    for (size_t i = 1; i < table.size(); ++i) {
        values += bash_values(table[i], fmt::format("'{}'", table[i].name));
        options += fmt::format("      {}) words='{}' ;;\n", table[i].name,
                               option_words(options_after(table[i], program)));
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
  # --option=value: bash parts words at "=" if COMP_WORDBREAKS has it.
  if [ "$current" = "=" ]; then
    current=
  elif [ "$previous" = "=" ]; then
    previous=${{COMP_WORDS[COMP_CWORD-2]}}
  elif [[ $current == --*=* ]]; then
    previous=${{current%%=*}} before=${{current%%=*}}=
  fi
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
        joined(value_options(program), " | "), values, joined(command_names(table)),
        option_words(program.options), options);
}

/// Whether the words are names, which "=" and a value follow.
bool goes_on(const OptionRow& option) {
    return !option.choices.empty() && option.choices.front().ends_with('=');
}

/// Within the brackets and colons of zsh's _arguments.
std::string zsh_text(const std::string& text) {
    std::string escaped = quoted(text);
    for (const char* special : {"[", "]", ":"})
        escaped = replaced(escaped, special, fmt::format("\\{}", special));
    return escaped;
}

/// What completes the option's value.
std::string zsh_action(const OptionRow& option) {
    const std::string words = zsh_text(joined(option.choices));
    if (option.is_list) return "_sequence compadd - " + words;
    if (goes_on(option)) return "_easypbr_pair - " + words;
    if (!words.empty()) return fmt::format("({})", words);
    return option.takes_file ? "_files" : " ";
}

/// Specifications of _arguments, a line each that ends in `end`.
std::string zsh_options(const std::vector<OptionRow>& options, std::string_view end) {
    std::string text;
    for (const OptionRow& option : options) {
        const std::string value =
            option.placeholder.empty()
                ? ""
                : fmt::format(":{}:{}", zsh_text(option.placeholder), zsh_action(option));
        for (const std::string& name : with_dashes(option)) {
            // With it the value may also follow in the same word.
            const std::string_view equals = !value.empty() && name.starts_with("--") ? "=" : "";
            text += fmt::format("        '*{}{}[{}]{}'{}\n", name, equals, zsh_text(option.help), value, end);
        }
    }
    return text;
}

std::string zsh_arguments(const CommandRow& command) {
    const std::string words = argument_words(command);
    if (words.empty()) return "'*:FILE:_files'";
    return fmt::format("'1:{}:({})'", zsh_text(command.arguments.front().long_names.front()),
                       zsh_text(words));
}

std::string zsh_completion(const std::vector<CommandRow>& table) {
    const CommandRow& program = table.front();
    std::string commands, cases;
    for (size_t i = 1; i < table.size(); ++i) {
        const CommandRow& command = table[i];
        commands += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.help));
        cases += fmt::format("    {})\n      _arguments \\\n{}        {} ;;\n", command.name,
                             zsh_options(options_after(command, program), " \\"), zsh_arguments(command));
    }
    return fmt::format(R"(#compdef easypbr
# Completion of easypbr for zsh, made from its table of options: easypbr completion zsh
# NAME=VALUE, where the value may be a file.
_easypbr_pair() {{
  if compset -P 1 '*='; then _files; else compadd -S '' "$@"; fi
}}
_easypbr() {{
  local -a commands program
  commands=(
{}  )
  program=(
{}  )
  # At i stands the command, or what is completed in its place; beyond CURRENT: an option's value is completed.
  integer i
  for (( i = 2; i < CURRENT; ++i )); do
    case $words[i] in
    {}) (( ++i )) ;;
    -*) ;;
    *) break ;;
    esac
  done
  if (( i == CURRENT )) && [[ $words[CURRENT] != -* ]]; then
    _describe command commands
    return
  elif (( i >= CURRENT )); then
    _arguments $program
    return
  fi
  local command=$words[i]
  shift $(( i - 1 )) words
  (( CURRENT -= i - 1 ))
  case $command in
{}  esac
}}
if [ "$funcstack[1]" = _easypbr ]; then _easypbr "$@"; else compdef _easypbr easypbr; fi
)",
                       commands, zsh_options(program.options, ""), joined(value_options(program), " | "),
                       cases);
}

/// Within single quotes of fish.
std::string fish_text(const std::string& text) {
    return replaced(replaced(text, "\\", "\\\\"), "'", "\\'");
}

/// What completes the option's value.
std::string fish_value(const OptionRow& option) {
    const std::string words = fish_text(joined(option.choices));
    if (option.is_list) return fmt::format(" -x -a '(__fish_append , {})'", words);
    if (goes_on(option)) return fmt::format(" -x -a '(__easypbr_pair {})'", words);
    if (!words.empty()) return fmt::format(" -x -a '{}'", words);
    return option.placeholder.empty() ? "" : option.takes_file ? " -r -F" : " -x";
}

/// The options that are offered where `condition` holds.
std::string fish_options(const std::vector<OptionRow>& options, const std::string& condition) {
    std::string text;
    for (const OptionRow& option : options) {
        text += fmt::format("complete -c easypbr -n '{}'", condition);
        for (const std::string& name : option.short_names) text += " -s " + name;
        for (const std::string& name : option.long_names) text += " -l " + name;
        text += fmt::format("{} -d '{}'\n", fish_value(option), fish_text(option.help));
    }
    return text;
}

/// Functions that tell which command is on the line, and that complete pairs. Without an argument,
/// __easypbr_is tells that no command is.
std::string fish_functions(const CommandRow& program) {
    return fmt::format(R"(function __easypbr_command
    set -l is_value 0
    for word in (commandline -opc)[2..-1]
        if test $is_value = 1
            set is_value 0
        else if contains -- $word {}
            set is_value 1
        else if not string match -q -- '-*' $word
            echo $word
            return
        end
    end
end
function __easypbr_is
    set -l command (__easypbr_command)
    test "$command" = "$argv"
end
# NAME=VALUE, where the value may be a file.
function __easypbr_pair
    set -l typed (string replace -r -- '^--[^=]*=' '' (commandline -ct))
    if set -l name (string match -r -- '^[^=]*=' $typed)
        __fish_complete_path (string replace -- $name '' $typed) | string replace -r -- '^' $name
    else
        printf '%s\n' $argv
    end
end
)",
                       joined(value_options(program)));
}

std::string fish_completion(const std::vector<CommandRow>& table) {
    const CommandRow& program = table.front();
    std::string text =
        "# Completion of easypbr for fish, made from its table of options: easypbr completion fish\n" +
        fish_functions(program);
    for (size_t i = 1; i < table.size(); ++i)
        text += fmt::format("complete -c easypbr -n __easypbr_is -f -a {} -d '{}'\n", table[i].name,
                            fish_text(table[i].help));
    text += fish_options(program.options, "__easypbr_is");
    for (size_t i = 1; i < table.size(); ++i) {
        const std::string condition = "__easypbr_is " + table[i].name;
        if (const std::string words = argument_words(table[i]); !words.empty())
            text += fmt::format("complete -c easypbr -n '{}' -f -a '{}'\n", condition, fish_text(words));
        text += fish_options(options_after(table[i], program), condition);
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
