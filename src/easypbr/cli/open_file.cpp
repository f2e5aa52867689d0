#include "easypbr/cli/open_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>

#include <cstring>

#include "easypbr/core/error.h"
#include "easypbr/core/program.h"

extern char** environ;

namespace easypbr::cli {

namespace fs = std::filesystem;

std::string opening_program() {
    if (const auto program = program_in_path("xdg-open")) return program->string();
    throw ContextError("render: --open needs xdg-open in PATH (Debian: apt install xdg-utils)");
}

void open_with(const std::string& program, const fs::path& file) {
    std::string name = program, argument = fs::absolute(file).string();
    char* const arguments[] = {name.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    // What the program says later must not mix with the shell's next line.
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw ContextError(fmt::format("cannot run {}: {}", program, std::strerror(error)));
}

}  // namespace easypbr::cli
