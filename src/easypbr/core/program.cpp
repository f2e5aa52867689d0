#include "easypbr/core/program.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>

namespace easypbr {

std::optional<std::filesystem::path> program_in_path(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
    std::error_code error;
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path program = std::filesystem::path(folder) / name;
        if (program.is_absolute() && std::filesystem::is_regular_file(program, error) &&
            ::access(program.c_str(), X_OK) == 0)
            return program;
    }
    return std::nullopt;
}

}  // namespace easypbr
