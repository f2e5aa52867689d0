// What the subcommands share: how they are added, how they fail.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr::cli {

namespace fs = std::filesystem;

/// The command itself is wrong: exit code 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What a parsed subcommand does; returns the exit code, throws UsageError or easypbr::Error.
using Job = std::function<int()>;

/// Each adds its subcommand to `app`; parsing that subcommand sets `job`.
void add_render(CLI::App& app, Job& job);
void add_info(CLI::App& app, Job& job);
void add_convert(CLI::App& app, Job& job);
void add_doctor(CLI::App& app, Job& job);
void add_compare(CLI::App& app, Job& job);
void add_view(CLI::App& app, Job& job);
void add_serve(CLI::App& app, Job& job);
void add_demo(CLI::App& app, Job& job);
void add_thumbnail(CLI::App& app, Job& job);
void add_dataset(CLI::App& app, Job& job);
void add_cache(CLI::App& app, Job& job);
void add_completion(CLI::App& app, Job& job);
void add_man(CLI::App& app, Job& job);

/// Calls `check`, which looks at options alone, not at what files hold: what the library refuses there makes
/// the command itself wrong. Throws UsageError for its ArgumentError or NameError.
template <class Check>
auto of_options(Check&& check) {
    try {
        return check();
    } catch (const ArgumentError& error) {
        throw UsageError(error.what());
    } catch (const NameError& error) {
        throw UsageError(error.what());
    }
}

template <class Options>
void check_nothing(const Options&) {}

/// Makes `command` set `job` to check(options), as of_options() calls it, and run(options) when it is parsed;
/// Options is a struct that `declare` ties to the command's options.
template <class Options>
void set_job(CLI::App& command, Job& job, void (*declare)(CLI::App&, Options&), int (*run)(const Options&),
             void (*check)(const Options&) = check_nothing<Options>) {
    const auto options = std::make_shared<Options>();
    declare(command, *options);
    command.callback([&job, options, run, check] {
        job = [options, run, check] {
            of_options([&] { check(*options); });
            return run(*options);
        };
    });
}

/// The formats that `dataset --writers` takes.
std::vector<std::string> dataset_writers();

/// Throws UsageError "COMMAND: expected WHAT" unless `given`.
void require(bool given, std::string_view command, std::string_view what);

/// Whether the extension is one of an image file that can be read.
bool is_image_file(const fs::path& path);

}  // namespace easypbr::cli
