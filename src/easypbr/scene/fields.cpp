#include "easypbr/scene/fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <map>

#include "easypbr/core/ascii.h"
#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/named_colors.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/colormap.h"
#include "easypbr/scene/field_builder.h"
#include "easypbr/scene/settings.h"
#include "easypbr/scene/synonyms.h"

namespace easypbr {
namespace {

std::string_view last_part(std::string_view name) {
    return name.substr(name.rfind('.') + 1);
}

/// The full names whose last part is `last`, quoted.
std::string names_ending_in(std::string_view last) {
    std::vector<std::string> names;
    for (const Field& field : fields())
        if (last_part(field.name) == last) names.push_back("'" + field.name + "'");
    return fmt::format("{}", fmt::join(names, " or "));
}

/// " (a group of settings: 'rays.enabled', ...)"; empty: it is none.
std::string group_hint(std::string_view name) {
    const std::string prefix = std::string(name) + ".";
    std::string members;
    size_t count = 0;
    for (const Field& field : fields())
        if (field.name.starts_with(prefix) && ++count <= 3)
            members += (members.empty() ? "'" : ", '") + field.name + "'";
    return count == 0 ? "" : fmt::format(" (a group of settings: {}{})", members, count > 3 ? ", ..." : "");
}

/// The setting in the group of `wrong` that `meant` is another word for: of "background.colour"
/// "background.color", of "ground.colour" "ground.plane_color". Empty: none, or several.
std::string meant_in_group(std::string_view wrong, const Synonym& meant) {
    const size_t dot = wrong.rfind('.');
    if (dot == wrong.npos) return {};
    const std::string_view group = wrong.substr(0, dot + 1);
    const std::string last(last_part(meant.setting));
    std::vector<std::string> names;
    for (const Field& field : fields()) {
        if (!field.name.starts_with(group)) continue;
        if (field.name.substr(group.size()) == last) return field.name;
        if (field.name.ends_with("_" + last)) names.push_back(field.name);
    }
    return names.size() == 1 ? names.front() : "";
}

/// Words of other programs, then names that begin with what was written, then names that are nearly it, then
/// names whose last part nearly is.
std::string hint_for(std::string_view wrong) {
    if (const Synonym* meant = synonym(last_part(wrong)); meant && !meant->setting.empty()) {
        const std::string own = meant_in_group(wrong, *meant);
        return fmt::format(" (it is called '{}')", own.empty() ? meant->setting : own);
    }
    if (const std::string group = group_hint(wrong); !group.empty()) return group;
    std::vector<std::string> names, last_parts;
    for (const Field& field : fields()) {
        if (wrong.size() >= 4 && field.name.starts_with(wrong) && wrong.find('.') != wrong.npos)
            return fmt::format(" (did you mean '{}'?)", field.name);
        names.push_back(field.name);
        last_parts.emplace_back(last_part(field.name));
    }
    if (const std::string hint = did_you_mean(wrong, names); !hint.empty()) return hint;
    const std::string last = nearest(last_part(wrong), last_parts);
    return last.empty() ? "" : fmt::format(" (did you mean {}?)", names_ending_in(last));
}

std::string describe_range(const FieldInfo& field) {
    const std::string kind = field.whole ? "whole number" : "number";
    const bool from = field.min > -FLT_MAX, to = field.max < FLT_MAX;
    const std::string unit = field.unit.empty() ? "" : " " + field.unit;
    if (from && to)
        return fmt::format("{}{} to {}{}", field.whole ? "a whole number from " : "", field.min, field.max,
                           unit);
    if (from) return fmt::format("a {} of at least {}{}", kind, field.min, unit);
    if (to) return fmt::format("a {} of at most {}{}", kind, field.max, unit);
    return "a " + kind;
}

/// "2 numbers", "none, 6 or 7 numbers", "a multiple of 4 numbers, up to 64", of ascending sizes.
std::string describe_sizes(const std::vector<size_t>& sizes) {
    const auto other_step = [&](size_t a, size_t b) { return b - a != sizes[1]; };
    const bool even = sizes.front() == 0 && std::ranges::adjacent_find(sizes, other_step) == sizes.end();
    if (sizes.size() > 2 && even)
        return fmt::format("a multiple of {} numbers, up to {}", sizes[1], sizes.back());
    std::string text;
    for (size_t i = 0; i < sizes.size(); ++i) {
        if (i > 0) text += i + 1 == sizes.size() ? " or " : ", ";
        text += sizes[i] == 0 ? "none" : fmt::format("{}", sizes[i]);
    }
    return text + " numbers";
}

std::string describe_vector(const FieldInfo& field) {
    const bool free = field.min <= -FLT_MAX && field.max >= FLT_MAX;
    return describe_sizes(field.sizes) + (free ? "" : ", each " + describe_range(field)) +
           (field.is_box ? ", no minimum above its maximum" : "");
}

std::string describe_expected(const FieldInfo& field) {
    const std::string or_auto = field.can_be_automatic ? ", or 'auto' or 'follow'" : "";
    switch (field.type) {
        case FieldType::boolean:
            return "true or false" + or_auto;
        case FieldType::integer:
        case FieldType::number:
            return describe_range(field) + or_auto;
        case FieldType::color:
            return fmt::format("a colour: {}", color_forms) + or_auto;
        case FieldType::vector:
            return describe_vector(field) + or_auto;
        case FieldType::text:
            return "a text" + or_auto;
        case FieldType::choice:
            return fmt::format("one of {}", fmt::join(field.choices, ", ")) + or_auto;
        case FieldType::colormap:
            return "a colour map: a name such as 'viridis', or colours such as '#000080,#ffffff,#800000'" +
                   or_auto;
    }
    return {};
}

std::string describe_given(const Value& value) {
    if (value.state == Value::State::follow) return "'follow'";
    if (value.state == Value::State::automatic && !value.latched) return "'auto'";
    struct Printer {
        std::string operator()(bool b) const { return b ? "true" : "false"; }
        std::string operator()(double number) const { return fmt::format("{}", number); }
        std::string operator()(const std::string& text) const { return "'" + text + "'"; }
        std::string operator()(const std::vector<double>& numbers) const {
            return numbers.size() > 16 ? fmt::format("{} numbers", numbers.size())
                                       : fmt::format("({})", fmt::join(numbers, ", "));
        }
    };
    return std::visit(Printer{}, value.data);
}

bool is_finite(const Value& value) {
    const auto* numbers = std::get_if<std::vector<double>>(&value.data);
    return !numbers || std::ranges::all_of(*numbers, [](double number) { return std::isfinite(number); });
}

std::string hint_for(const FieldInfo& field, const Value& value) {
    const auto* text = std::get_if<std::string>(&value.data);
    if (!text) return {};
    if (field.type == FieldType::choice) return did_you_mean(*text, field.choices);
    return field.type == FieldType::color ? did_you_mean(*text, color_names()) : "";
}

[[noreturn]] void reject(const FieldInfo& field, std::string_view owner, std::string_view expected,
                         std::string_view given) {
    const std::string place =
        owner.empty() ? fmt::format("setting '{}'", field.name) : fmt::format("{}{}", owner, field.name);
    throw ArgumentError(fmt::format("{}: expected {}, got {}", place, expected, given));
}

[[noreturn]] void reject(const FieldInfo& field, const Value& value, std::string_view owner) {
    reject(field, owner, is_finite(value) ? describe_expected(field) : "finite numbers",
           describe_given(value) + hint_for(field, value));
}

bool is_allowed(const FieldInfo& field, double number) {
    return std::isfinite(number) && number >= field.min && number <= field.max &&
           (!field.whole || number == std::floor(number));
}

/// Whether no number of the first half is above its counterpart of the second.
bool is_ordered(const std::vector<double>& box) {
    const auto half = std::ptrdiff_t(box.size() / 2);
    return std::ranges::equal(box.begin(), box.begin() + half, box.begin() + half, box.end(),
                              std::less_equal<>());
}

bool is_allowed(const FieldInfo& field, const std::vector<double>& numbers) {
    return std::find(field.sizes.begin(), field.sizes.end(), numbers.size()) != field.sizes.end() &&
           (!field.is_box || is_ordered(numbers)) &&
           std::all_of(numbers.begin(), numbers.end(),
                       [&](double number) { return is_allowed(field, number); });
}

bool is_colormap(const std::string& text) {
    try {
        parse_colormap(text);
        return true;
    } catch (const Error&) {
        return false;
    }
}

bool is_allowed(const FieldInfo& field, const Value::Data& data) {
    switch (field.type) {
        case FieldType::boolean:
            return std::holds_alternative<bool>(data);
        case FieldType::integer:
        case FieldType::number: {
            const auto* number = std::get_if<double>(&data);
            return number && is_allowed(field, *number);
        }
        case FieldType::color:
        case FieldType::vector: {
            const auto* numbers = std::get_if<std::vector<double>>(&data);
            return numbers && is_allowed(field, *numbers);
        }
        case FieldType::text:
            return std::holds_alternative<std::string>(data);
        case FieldType::choice: {
            const auto* text = std::get_if<std::string>(&data);
            return text &&
                   std::find(field.choices.begin(), field.choices.end(), *text) != field.choices.end();
        }
        case FieldType::colormap: {
            const auto* text = std::get_if<std::string>(&data);
            return text && is_colormap(*text);
        }
    }
    return false;
}

/// A choice in any case: F3D writes axes as +Z.
std::string spelled_as_chosen(const FieldInfo& field, const std::string& text) {
    for (const std::string& choice : field.choices)
        if (ascii::same_letters(choice, text)) return choice;
    return text;
}

}  // namespace

const Field& field(std::string_view name) {
    static const auto by_name = [] {
        std::map<std::string, const Field*, std::less<>> map;
        for (const Field& field : fields()) map.emplace(field.name, &field);
        return map;
    }();
    const auto found = by_name.find(name);
    if (found == by_name.end())
        throw NameError(fmt::format("there is no setting '{}'{}", name, hint_for(name)));
    return *found->second;
}

bool are_equal(const Settings& a, const Settings& b) {
    return std::ranges::all_of(fields(), [&](const Field& field) { return field.same(a, b); });
}

bool is_valid(const Field& field, const Value& value) {
    return is_allowed(field, value.data);
}

namespace {

/// A choice in the spelling of the table, the text of a colour as its numbers; other data as they are.
Value::Data data_as_put(const FieldInfo& field, const Value::Data& data) {
    const auto* text = std::get_if<std::string>(&data);
    if (text && field.type == FieldType::choice) return spelled_as_chosen(field, *text);
    if (text && field.type == FieldType::color)
        if (const auto color = find_color(*text)) return detail::to_data(*color);
    return data;
}

}  // namespace

Value checked(const FieldInfo& field, const Value& value, std::string_view owner) {
    const bool has_data = value.state == Value::State::given || value.latched;
    if (value.state != Value::State::given && !field.can_be_automatic) reject(field, value, owner);
    if (!has_data) return {{}, value.state};
    if (field.type == FieldType::colormap && std::holds_alternative<std::string>(value.data)) {
        Value parsed = parse_value(field, std::get<std::string>(value.data));
        if (parsed.state != Value::State::given) reject(field, value, owner);
        parsed.state = value.state;
        parsed.latched = value.latched;
        return parsed;
    }
    Value::Data data = data_as_put(field, value.data);
    if (!is_allowed(field, data)) reject(field, value, owner);
    return {std::move(data), value.state, value.latched};
}

void reject_value(const FieldInfo& field, std::string_view given, std::string_view owner) {
    constexpr size_t most_letters = 80;
    reject(field, owner, describe_expected(field), given.substr(0, most_letters));
}

void set(Settings& settings, std::string_view name, const Value& value) {
    const Field& target = field(name);
    target.put(settings, checked(target, value));
}

Value get(const Settings& settings, std::string_view name) {
    return field(name).get(settings);
}

Value get(const InferredSettings& settings, std::string_view name) {
    return field(name).get_inferred(settings);
}

void set_from_text(Settings& settings, std::string_view name, std::string_view text) {
    set(settings, name, parse_value(field(name), text));
}

void set(Style& style, std::string_view name, const Value& value) {
    Settings settings;
    settings.style = style;
    set(settings, "style." + std::string(name), value);
    style = settings.style;
}

Value get(const Style& style, std::string_view name) {
    Settings settings;
    settings.style = style;
    return get(settings, "style." + std::string(name));
}

void validate(const Style& style, std::string_view owner) {
    Settings settings;
    settings.style = style;
    for (const Field& field : fields())
        if (field.name.starts_with("style.")) checked(field, field.get(settings), owner);
}

void set_from_text(Style& style, std::string_view name, std::string_view text) {
    set(style, name, parse_value(field("style." + std::string(name)), text));
}

}  // namespace easypbr
