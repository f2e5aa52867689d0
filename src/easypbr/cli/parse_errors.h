// What is wrong with an option, in the words of this program instead of CLI11's.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace easypbr::cli {

/// What the parser found, "--fps: expected a number, got 'abc'"; its own words for what is of no single
/// option.
std::string parse_error_text(const CLI::App& app, const CLI::ParseError& error);

/// What CLI11 says of an option's values: "INT:{8,16}".
std::vector<std::string> listed_values(const CLI::Option& option);

/// Takes numbers from 0 on; not a number (nan) is none of them.
CLI::Validator at_least_zero();

}  // namespace easypbr::cli
