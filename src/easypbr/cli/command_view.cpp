#include "easypbr/cli/command.h"
#include "easypbr/core/error.h"

namespace easypbr::cli {
namespace {

struct ViewOptions {
    std::vector<std::string> files;
};

void declare(CLI::App& command, ViewOptions& options) {
    command.add_option("FILE", options.files, "Meshes");
}

int run(const ViewOptions& options) {
    const std::string file = options.files.empty() ? "FILE" : options.files.front();
    throw Error("view: this version has no window; use 'easypbr render " + file + " -o OUT.png'");
}

}  // namespace

void add_view(CLI::App& app, Job& job) {
    set_job<ViewOptions>(*app.add_subcommand("view", "Show mesh files in a window (not in this version)"),
                         job, declare, run);
}

}  // namespace easypbr::cli
