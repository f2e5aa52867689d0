#include "easypbr/cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <string>

#include "easypbr/core/log.h"

namespace easypbr::cli {
namespace {

constexpr const char* erase_line = "\r\033[K";

/// What cannot be written there is lost: there is nowhere to say so.
void print_text(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
}

std::mutex mutex;
bool bar_is_shown = false;

void erase_bar() {
    if (bar_is_shown) print_text(erase_line);
    bar_is_shown = false;
}

void print_line(const char* kind, std::string_view message) {
    std::string line(message);
    std::replace(line.begin(), line.end(), '\n', ' ');
    const std::lock_guard lock(mutex);
    erase_bar();
    print_text(fmt::format("easypbr: {}: {}\n", kind, line));
}

void print_progress(std::string_view what, double fraction) {
    constexpr int width = 30;
    const std::lock_guard lock(mutex);
    if (fraction >= 1) return erase_bar();
    const int filled = std::clamp(int(fraction * width), 0, width);
    print_text(fmt::format("{}[{:=<{}}{:{}}] {:3.0f} % {}", erase_line, "", filled, "", width - filled,
                           fraction * 100, what));
    bar_is_shown = true;
}

}  // namespace

Console::Console() {
    set_log_sink([](LogLevel level, std::string_view message) {
        if (level == LogLevel::warning) print_warning(message);
    });
    if (::isatty(STDERR_FILENO)) set_progress_sink(print_progress);
}

Console::~Console() {
    be_quiet();
}

void print_note(std::string_view message) {
    const std::lock_guard lock(mutex);
    erase_bar();
    print_text(fmt::format("easypbr: {}\n", message));
}

void print_warning(std::string_view message) {
    print_line("warning", message);
}

void print_error(std::string_view message) {
    print_line("error", message);
}

void be_quiet() {
    set_log_sink({});
    set_progress_sink({});
    const std::lock_guard lock(mutex);
    erase_bar();
}

}  // namespace easypbr::cli
