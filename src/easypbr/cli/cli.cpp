#include "easypbr/cli/cli.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>

#include "easypbr/cli/command.h"
#include "easypbr/cli/console.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"

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

[[noreturn]] void fail_without_subcommand(const CLI::App& app) {
    const std::vector<std::string> rest = app.remaining();
    if (rest.empty())
        throw UsageError("expected a command: " + fmt::format("{}", fmt::join(subcommand_names(app), ", ")));
    std::string hint = did_you_mean(rest.front(), subcommand_names(app));
    if (rest.front().starts_with("-")) hint = did_you_mean(rest.front(), option_names(app));
    if (hint.empty() && fs::exists(rest.front()))
        hint = fmt::format(" (did you mean 'easypbr render {}'?)", rest.front());
    throw UsageError(fmt::format("unknown command '{}'{}; expected one of {}", rest.front(), hint,
                                 fmt::join(subcommand_names(app), ", ")));
}

/// Extras are allowed while parsing, so that a misspelt option is reported before what it left missing.
void reject_extras(const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    if (commands.empty()) fail_without_subcommand(app);
    const CLI::App& command = *commands.front();
    for (const std::vector<std::string>& rest : {command.remaining(), app.remaining()}) {
        if (rest.empty()) continue;
        if (!rest.front().starts_with("-"))
            throw UsageError(fmt::format("{}: unexpected argument '{}'", command.get_name(), rest.front()));
        const std::string name = rest.front().substr(0, rest.front().find('='));
        throw UsageError(fmt::format("{}: unknown option '{}'{}", command.get_name(), name,
                                     did_you_mean(name, option_names(command))));
    }
}

void add_commands(CLI::App& app, Job& job) {
    app.name("easypbr");
    app.set_version_flag("--version", "easypbr " EASYPBR_VERSION, "Print the version and exit");
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
    add_dataset(app, job);
    add_cache(app, job);
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
        throw UsageError(error.what());
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
