// stderr: one line per error and warning, and a progress bar on a terminal. That it is full or closed is no
// error.
#pragma once

#include <string_view>

namespace easypbr::cli {

/// While it lives, the library's warnings and progress go to stderr.
class Console {
  public:
    Console();
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;
};

/// "easypbr: MESSAGE" on one line.
void print_note(std::string_view message);
/// "easypbr: warning: MESSAGE" on one line.
void print_warning(std::string_view message);
/// "easypbr: error: MESSAGE" on one line.
void print_error(std::string_view message);

/// Silences warnings and progress until the Console ends; errors are still printed.
void be_quiet();

}  // namespace easypbr::cli
