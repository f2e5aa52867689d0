// The generator of data sets is a part of the Python package; this hands over to it.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
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
/// has an option against it (-P) from 3.11 on only. Ctrl-C, which run_dataset() has blocked, ends the imports
/// as it ends main(): KeyboardInterrupt would leave them with a traceback, and numpy takes it for a broken
/// installation.
constexpr const char* start =
    "import sys\n"
    "sys.path[:] = [folder for folder in sys.path if folder]\n"
    "import os, signal\n"
    "def end(*_):\n"
    "    try:\n"
    "        os.write(2, b'easypbr: interrupted: started again it goes on\\n')\n"
    "    finally:\n"
    "        os._exit(130)\n"
    "if signal.getsignal(signal.SIGINT) is signal.default_int_handler:\n"  // Else it is ignored.
    "    signal.signal(signal.SIGINT, end)\n"
    "signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})\n"
    "try:\n"
    "    from easypbr.dataset.__main__ import main\n"
    "except ModuleNotFoundError as error:\n"
    "    sys.exit(f'easypbr: error: dataset: {sys.executable} has no module {error.name}: "
    "the generator is a part of the Python package; "
    "pip install easypbr, or set EASYPBR_PYTHON to the Python that has it')\n"
    "try:\n"
    "    if signal.getsignal(signal.SIGINT) is end:\n"
    "        signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    "    code = main()\n"
    "except KeyboardInterrupt:\n"
    "    end()\n"
    "sys.exit(code)\n";

struct DatasetOptions {
    std::string spec;
    std::vector<std::string> arguments;  ///< options as the generator takes them
};

struct PassedOption {
    const char *names, *placeholder, *help;
};

constexpr PassedOption passed_options[] = {
    {"-o,--output", "FOLDER", "Folder to write; an interrupted run resumes with the missing frames"},
    {"--count", "N", "Number of images"},
    {"--seed", "N", "Seed of the random numbers"},
    {"--workers", "N", "Worker processes; default: one per two cores"},
    {"--threads", "N", "Cores of each worker; default: all cores divided among the workers, 1 with Ray"},
    {"--engine", "local|ray", "Scheduler of the workers: local, or ray (pip install 'easypbr[ray]')"},
    {"--address", "ADDRESS",
     "Ray cluster: HOST:PORT, or auto; its machines share the folder. Default: this machine"},
    {"--writers", "A,B",
     "Formats: coco, yolo, kitti, flow, bop, nerfstudio, colmap, webdataset, raw, exr, png"},
    {"--on-error", "stop|skip", "Unreadable mesh: stop, or skip and report it"}};

void declare_dataset(CLI::App& command, DatasetOptions& options) {
    std::vector<std::string>& arguments = options.arguments;
    command.add_option("spec", options.spec, "Specification of the data set, a TOML file")
        ->option_text("SPEC");
    command.add_flag_callback(
        "--demo", [&arguments] { arguments.emplace_back("--demo"); },
        "Generate the built-in drones instead of a SPEC");
    for (const PassedOption& passed : passed_options) {
        // An empty value is one too: the generator says what is wrong with it.
        const std::string names = passed.names, name = names.substr(names.rfind("--"));
        command
            .add_option_function<std::string>(
                names,
                [&arguments, name](const std::string& value) {
                    arguments.push_back(fmt::format("{}={}", name, value));
                },
                passed.help)
            ->option_text(passed.placeholder);
    }
    command.add_flag_callback(
        "-q,--quiet", [&arguments] { arguments.emplace_back("--quiet"); },
        "Print neither progress nor a summary");
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

int run_dataset(const DatasetOptions& options) {
    std::vector<std::string> arguments = {python(), "-c", start};
    arguments.insert(arguments.end(), options.arguments.begin(), options.arguments.end());
    if (!options.spec.empty()) arguments.insert(arguments.end(), {"--", options.spec});
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    // For the worker processes, which are started by Python itself.
    setenv("PYTHONSAFEPATH", "1", 1);
    std::fflush(nullptr);
    // Until Python has started, which takes a while, Ctrl-C waits: its own handler shows a traceback.
    sigset_t interrupt, before;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    pthread_sigmask(SIG_BLOCK, &interrupt, &before);
    execv(pointers[0], pointers.data());
    const int failure = errno;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw ContextError(
        fmt::format("dataset: cannot run {} ({}): {}", arguments[0], std::strerror(failure), hint));
}

}  // namespace

std::vector<std::string> dataset_writers() {
    return {"coco",   "yolo",       "kitti", "flow", "bop", "nerfstudio",
            "colmap", "webdataset", "raw",   "exr",  "png"};
}

void add_dataset(CLI::App& app, Job& job) {
    set_job<DatasetOptions>(*app.add_subcommand("dataset", "Generate annotated images for training"), job,
                            declare_dataset, run_dataset);
}

}  // namespace easypbr::cli
