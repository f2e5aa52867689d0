// --open: shows a file in the program that the desktop has for it.
#pragma once

#include <filesystem>
#include <string>

namespace easypbr::cli {

/// The absolute path of the program that opens files: xdg-open, from PATH. Throws ContextError.
std::string opening_program();

/// Starts the program with a file and does not wait for it. Throws ContextError when it cannot be started.
void open_with(const std::string& program, const std::filesystem::path& file);

}  // namespace easypbr::cli
