#include "easypbr/cli/parse_errors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "easypbr/core/suggest.h"

namespace easypbr::cli {
namespace {

constexpr const char* zero_and_more = "NONNEGATIVE";

/// The option that a message of CLI11 is about: "--size: ..." or "Could not convert: --size = ...".
const CLI::Option* option_in(const CLI::App& app, std::string message) {
    const std::string conversion = "Could not convert: ";
    if (message.starts_with(conversion)) message.erase(0, conversion.size());
    const std::string name = message.substr(0, message.find_first_of(": "));
    for (const CLI::Option* option : app.get_options())
        if (option->get_name() == name) return option;
    return nullptr;
}

/// "a, b or c".
std::string any_of(const std::vector<std::string>& values) {
    if (values.size() < 2) return fmt::format("{}", fmt::join(values, ""));
    return fmt::format("{} or {}", fmt::join(values.begin(), values.end() - 1, ", "), values.back());
}

std::string expected_value(const CLI::Option& option) {
    if (const std::vector<std::string> values = listed_values(option); !values.empty()) return any_of(values);
    const std::string type = option.get_type_name();
    const int count = option.get_items_expected_min();
    if (type.starts_with("INT")) return "a whole number";
    if (type.starts_with("UINT")) return "a whole number from 0 on";
    if (type.ends_with(zero_and_more)) return "a number of 0 or more";
    if (type.starts_with("FLOAT")) return count > 1 ? fmt::format("{} numbers", count) : "a number";
    const std::string& placeholder = option.get_option_text();
    return placeholder.empty() || count == 0 ? "a value" : placeholder;
}

std::string given_value(const CLI::Option& option) {
    return fmt::format("'{}'", fmt::join(option.results(), ","));
}

std::string wrong_count(const CLI::Option& option) {
    const size_t given = option.results().size();
    if (given == 0) return fmt::format("expected {}, got nothing", expected_value(option));
    if (option.get_items_expected_max() > 1)
        return fmt::format("expected {} values, got {}", option.get_items_expected_max(), given);
    return fmt::format("expected it once, got it {} times: {}", given, fmt::join(option.results(), ", "));
}

std::string wrong_value(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0)
        return fmt::format("expected no value, got {}", given_value(option));
    const std::vector<std::string> values = listed_values(option);
    const std::string hint = option.results().empty() ? "" : did_you_mean(option.results().front(), values);
    return fmt::format("expected {}, got {}{}", expected_value(option), given_value(option), hint);
}

}  // namespace

std::vector<std::string> listed_values(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const size_t begin = type.find('{'), end = type.rfind('}');
    std::vector<std::string> values;
    if (begin == type.npos || end == type.npos || end < begin) return values;
    std::istringstream list(type.substr(begin + 1, end - begin - 1));
    for (std::string value; std::getline(list, value, ',');) values.push_back(value);
    return values;
}

std::string parse_error_text(const CLI::App& app, const CLI::ParseError& error) {
    const bool is_count = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr;
    const bool is_value = dynamic_cast<const CLI::ConversionError*>(&error) ||
                          dynamic_cast<const CLI::ValidationError*>(&error);
    if (!is_count && !is_value) return error.what();
    std::vector<const CLI::App*> owners = {&app};
    for (const CLI::App* command : app.get_subcommands()) owners.push_back(command);
    for (const CLI::App* owner : owners)
        if (const CLI::Option* option = option_in(*owner, error.what()))
            return fmt::format("{}: {}", option->get_name(),
                               is_count ? wrong_count(*option) : wrong_value(*option));
    return error.what();
}

CLI::Validator at_least_zero() {
    return {[](const std::string& text) {
                double number = 0;
                const bool fits = CLI::detail::lexical_cast(text, number) && number >= 0;
                return std::string(fits ? "" : "not from 0 on");
            },
            zero_and_more};
}

}  // namespace easypbr::cli
