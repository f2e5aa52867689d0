// The generator of data sets is a part of the Python package; this hands over to it.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "easypbr/cli/command.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/program.h"

namespace easypbr::cli {
namespace {

constexpr const char* hint =
    "the generator is a part of the Python package; set EASYPBR_PYTHON to the Python that has it";

/// `python -m` would search the current folder for modules first, and run a numpy.py that lies there. Python
/// has an option against it (-P) from 3.11 on only.
constexpr const char* start =
    "import sys\n"
    "sys.path[:] = [folder for folder in sys.path if folder]\n"
    "try:\n"
    "    from easypbr.dataset.__main__ import main\n"
    "except ModuleNotFoundError as error:\n"
    "    sys.exit(f'easypbr: error: dataset: {sys.executable} has no module {error.name}: the generator is a "
    "part of the "
    "Python package; pip install easypbr, or set EASYPBR_PYTHON to the Python that has it')\n"
    "sys.exit(main())\n";

struct DatasetOptions {
    std::string spec, output, count, seed, workers, threads, engine, address, writers, on_error;
    bool demo = false, quiet = false;
};

void declare_dataset(CLI::App& command, DatasetOptions& o) {
    command.add_option("spec", o.spec, "Specification of the data set, a TOML file")->option_text("SPEC");
    command.add_flag("--demo", o.demo, "Generate the built-in drones instead of a SPEC");
    command
        .add_option("-o,--output", o.output,
                    "Folder to write; an interrupted run resumes with the missing frames")
        ->option_text("FOLDER");
    command.add_option("--count", o.count, "Number of images")->option_text("N");
    command.add_option("--seed", o.seed, "Seed of the random numbers")->option_text("N");
    command.add_option("--workers", o.workers, "Worker processes; default: one per two cores")
        ->option_text("N");
    command
        .add_option("--threads", o.threads,
                    "Cores of each worker; default: all cores divided among the workers, 1 with Ray")
        ->option_text("N");
    command
        .add_option("--engine", o.engine,
                    "Scheduler of the workers: local, or ray (pip install 'easypbr[ray]')")
        ->option_text("local|ray");
    command
        .add_option("--address", o.address,
                    "Ray cluster: HOST:PORT, or auto; its machines share the folder. Default: this machine")
        ->option_text("ADDRESS");
    command
        .add_option("--writers", o.writers,
                    "Formats, separated by commas: coco, yolo, kitti, flow, bop, nerfstudio, "
                    "colmap, webdataset, raw, exr, png")
        ->option_text("NAMES");
    command.add_option("--on-error", o.on_error, "Unreadable mesh: stop, or skip and report it")
        ->option_text("stop|skip");
    command.add_flag("-q,--quiet", o.quiet, "Suppress progress");
}

std::string found_in_path(const std::string& name) {
    if (const auto program = program_in_path(name)) return program->string();
    throw ContextError(fmt::format("dataset: there is no {} in PATH: {}", name, hint));
}

bool same_owner(const fs::path& a, const fs::path& b) {
    struct stat of_a = {}, of_b = {};
    return stat(a.c_str(), &of_a) == 0 && stat(b.c_str(), &of_b) == 0 && of_a.st_uid == of_b.st_uid;
}

/// Python's absolute path. The package sets the variable when it runs the command line itself; where `make
/// build` has made this program, its environment stands beside the build folder.
std::string python() {
    if (const char* given = std::getenv("EASYPBR_PYTHON"); given && *given)
        return std::strchr(given, '/') ? fs::absolute(given).string() : found_in_path(given);
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    const fs::path own = self.parent_path().parent_path() / ".venv/bin/python";
    // Of a program in a folder that others may write to, such as /tmp, the environment may be theirs.
    const bool is_ours = !error && same_owner(self, own.parent_path()) && fs::exists(own, error);
    return is_ours ? own.string() : found_in_path("python3");
}

int run_dataset(const DatasetOptions& o) {
    std::vector<std::string> arguments = {python(), "-c", start};
    if (!o.spec.empty()) arguments.push_back(o.spec);
    if (o.demo) arguments.emplace_back("--demo");
    if (o.quiet) arguments.emplace_back("--quiet");
    const std::pair<const char*, const std::string&> values[] = {
        {"--output", o.output},   {"--count", o.count},     {"--seed", o.seed},
        {"--workers", o.workers}, {"--threads", o.threads}, {"--engine", o.engine},
        {"--address", o.address}, {"--writers", o.writers}, {"--on-error", o.on_error}};
    for (const auto& [name, value] : values)
        if (!value.empty()) arguments.push_back(fmt::format("{}={}", name, value));
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    // For the worker processes, which are started by Python itself.
    setenv("PYTHONSAFEPATH", "1", 1);
    std::fflush(nullptr);
    execv(pointers[0], pointers.data());
    throw ContextError(
        fmt::format("dataset: cannot run {} ({}): {}", arguments[0], std::strerror(errno), hint));
}

}  // namespace

void add_dataset(CLI::App& app, Job& job) {
    set_job<DatasetOptions>(*app.add_subcommand("dataset", "Generate annotated images for training"), job,
                            declare_dataset, run_dataset);
}

}  // namespace easypbr::cli
