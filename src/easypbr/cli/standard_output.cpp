#include "easypbr/cli/standard_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "easypbr/cli/command.h"
#include "easypbr/core/error.h"

namespace easypbr::cli {

void check_standard_output(std::string_view command) {
    if (::isatty(STDOUT_FILENO))
        throw UsageError(
            fmt::format("{}: standard output is a terminal; redirect it or name a file", command));
}

void write_to_stdout(std::span<const std::byte> bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
        throw FileError("cannot write the picture to standard output");
}

}  // namespace easypbr::cli
