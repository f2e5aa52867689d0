#include "easypbr/cli/cli.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>

#include "easypbr/cli/command.h"
#include "easypbr/cli/console.h"
#include "easypbr/cli/parse_errors.h"
#include "easypbr/cli/render_options.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/picture.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/synonyms.h"

namespace easypbr::cli {
namespace {

constexpr int job_failed = 1, wrong_command = 2;

std::vector<std::string> subcommand_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

[[noreturn]] void fail_without_subcommand(const CLI::App& app, const std::vector<std::string>& rest) {
    if (rest.empty())
        throw UsageError("expected a command: " + fmt::format("{}", fmt::join(subcommand_names(app), ", ")));
    std::string hint = did_you_mean(rest.front(), subcommand_names(app));
    if (rest.front().starts_with("-")) hint = did_you_mean(rest.front(), option_names(app));
    std::error_code unreadable;
    if (hint.empty() && fs::exists(rest.front(), unreadable))
        hint = fmt::format(" (did you mean 'easypbr render {}'?)", rest.front());
    throw UsageError(fmt::format("unknown command '{}'{}; expected one of {}", rest.front(), hint,
                                 fmt::join(subcommand_names(app), ", ")));
}

/// The option of the command that sets this setting; --set does for all.
std::string option_for(const CLI::App& command, std::string_view setting) {
    const std::string shorthand = shorthand_option(setting);
    if (!shorthand.empty() && command.get_option_no_throw(shorthand)) return shorthand;
    return fmt::format("--set {}=VALUE", setting);
}

/// The setting whose last part an option is written as, "--point-size"; empty: none, or several.
std::string setting_like(std::string option) {
    option.erase(0, option.find_first_not_of('-'));
    std::ranges::replace(option, '-', '_');
    std::string found;
    for (const Field& field : fields())
        if (field.name.ends_with("." + option)) {
            if (!found.empty()) return {};
            found = field.name;
        }
    return found;
}

/// What an unknown option may mean: a word of another program, or a misspelt one.
std::string option_hint(const CLI::App& command, const std::string& name) {
    if (const std::string nearest = did_you_mean(name, option_names(command)); !nearest.empty())
        return nearest;
    const Synonym* meant = synonym(name);
    if (meant && meant->setting.empty()) return fmt::format(" ({})", meant->option);
    const std::string setting = meant ? std::string(meant->setting) : setting_like(name);
    return setting.empty() ? "" : fmt::format(" (it is called {})", option_for(command, setting));
}

/// What nothing has taken, without the "--" that ends options.
struct Extras {
    explicit Extras(const CLI::App& app) : words(app.remaining()) {
        const auto end_of_options = std::ranges::find(words, "--");
        if (end_of_options == words.end()) return;
        are_arguments = end_of_options == words.begin();
        words.erase(end_of_options);
    }

    std::vector<std::string> words;
    bool are_arguments = false;  ///< whatever they begin with
};

/// Extras are allowed while parsing, so that a misspelt option is reported before what it left missing.
void reject_extras(const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    if (commands.empty()) fail_without_subcommand(app, Extras(app).words);
    const CLI::App& command = *commands.front();
    for (const CLI::App* each : {&command, &app}) {
        const Extras extras(*each);
        if (extras.words.empty()) continue;
        const std::string& first = extras.words.front();
        if (extras.are_arguments || !first.starts_with("-"))
            throw UsageError(fmt::format("{}: unexpected argument '{}'", command.get_name(), first));
        const std::string name = first.substr(0, first.find('='));
        throw UsageError(
            fmt::format("{}: unknown option '{}'{}", command.get_name(), name, option_hint(command, name)));
    }
}

void add_commands(CLI::App& app, Job& job) {
    app.name("easypbr");
    app.set_version_flag("--version", "easypbr " EASYPBR_VERSION, "Print the version and exit");
    app.add_option_function<std::string>(
           "--device",
           [](const std::string& name) {
               of_options([&] { draw_device_named(name); });
               ::setenv("EASYPBR_DEVICE", name.c_str(), 1);
           },
           "What draws: gl, cpu, or auto for a GPU where there is one, else the CPU (EASYPBR_DEVICE)")
        ->option_text("auto|gl|cpu");
    app.fallthrough();
    app.require_subcommand(0, 1);
    app.allow_extras();
    add_render(app, job);
    add_demo(app, job);
    add_info(app, job);
    add_convert(app, job);
    add_compare(app, job);
    add_doctor(app, job);
    add_view(app, job);
    add_serve(app, job);
    add_thumbnail(app, job);
    add_dataset(app, job);
    add_cache(app, job);
    add_completion(app, job);
    add_man(app, job);
}

/// A full disk shows when what is still buffered is written, which nobody looks at when the process ends.
int with_output_written(int code) {
    std::cout.flush();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) || !std::cout)
        throw FileError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
    return code;
}

int parse_and_run(int argc, const char* const* argv) {
    CLI::App app("EasyPBR: a physically based renderer for meshes, point clouds and labelled data.");
    Job job;
    add_commands(app, job);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& wanted) {
        return with_output_written(app.exit(wanted, std::cout, std::cerr));
    } catch (const CLI::ParseError& error) {
        throw UsageError(parse_error_text(app, error));
    }
    reject_extras(app);
    return with_output_written(job());
}

}  // namespace

int run(int argc, const char* const* argv) {
    const Console console;
    try {
        return parse_and_run(argc, argv);
    } catch (const UsageError& error) {
        print_error(std::string(error.what()) + " (see 'easypbr --help')");
        return wrong_command;
    } catch (const std::bad_alloc&) {
        print_error("out of memory");
    } catch (const std::exception& error) {
        print_error(error.what());
    }
    return job_failed;
}

}  // namespace easypbr::cli
