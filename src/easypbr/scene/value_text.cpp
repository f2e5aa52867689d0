#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/colormap.h"
#include "easypbr/scene/field_builder.h"
#include "easypbr/scene/fields.h"

namespace easypbr {
namespace {

std::string_view trimmed(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t");
    if (begin == text.npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

std::optional<double> parse_number(std::string_view text) {
    text = trimmed(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<bool> parse_boolean(std::string_view text) {
    for (const char* yes : {"true", "on", "yes", "1"})
        if (text == yes) return true;
    for (const char* no : {"false", "off", "no", "0"})
        if (text == no) return false;
    return std::nullopt;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text, std::string_view separators) {
    std::vector<double> numbers;
    if (text.empty()) return numbers;
    for (;;) {
        const size_t end = text.find_first_of(separators);
        const auto number = parse_number(text.substr(0, end));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        if (end == text.npos) return numbers;
        text.remove_prefix(end + 1);
    }
}

/// The text itself stands for a value that cannot be read: the check then says what was expected.
template <class T>
Value value_or_text(std::optional<T> parsed, std::string_view text) {
    if (parsed) return {std::move(*parsed)};
    return {std::string(text)};
}

Value parse_colormap_value(const FieldInfo& field, std::string_view text) {
    try {
        return {parse_colormap(text).text()};
    } catch (const Error& error) {
        throw ArgumentError(fmt::format("setting '{}': {}", field.name, error.what()));
    }
}

std::string color_text(const std::vector<double>& numbers) {
    const Vec3 color = Vec3d(numbers[0], numbers[1], numbers[2]).cast<float>();
    const std::string hex = to_hex(color);
    return parse_color(hex) == color ? hex : fmt::format("{}", fmt::join(numbers, ","));
}

}  // namespace

Value parse_value(const FieldInfo& field, std::string_view given) {
    const std::string_view text = trimmed(given);
    if (field.can_be_automatic && text == "auto") return {{}, Value::State::automatic};
    if (field.can_be_automatic && text == "follow") return {{}, Value::State::follow};
    switch (field.type) {
        case FieldType::boolean:
            return checked(field, value_or_text(parse_boolean(text), text));
        case FieldType::integer:
        case FieldType::number:
            return checked(field, value_or_text(parse_number(text), text));
        case FieldType::vector:
            // 800x600 is how a size is commonly written.
            return checked(field, value_or_text(parse_numbers(text, field.whole ? ",x" : ","), text));
        case FieldType::color:
        case FieldType::choice:
            return checked(field, {std::string(text)});
        case FieldType::colormap:
            return parse_colormap_value(field, text);
        case FieldType::text:
            break;
    }
    return {std::string(given)};
}

std::string to_text(const FieldInfo& field, const Value& value) {
    if (value.state == Value::State::automatic) return "auto";
    if (value.state == Value::State::follow) return "follow";
    if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
    if (const auto* number = std::get_if<double>(&value.data)) return fmt::format("{}", *number);
    if (const auto* text = std::get_if<std::string>(&value.data)) return *text;
    const auto& numbers = std::get<std::vector<double>>(value.data);
    return field.type == FieldType::color ? color_text(numbers) : fmt::format("{}", fmt::join(numbers, ","));
}

}  // namespace easypbr
