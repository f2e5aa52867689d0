// Pictures to standard output.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace easypbr::cli {

/// Stands for standard output in place of a file.
inline constexpr const char* standard_output = "-";

/// Throws UsageError where standard output is a terminal, which shows no picture file.
void check_standard_output(std::string_view command);

/// Throws FileError.
void write_to_stdout(std::span<const std::byte> bytes);

}  // namespace easypbr::cli
