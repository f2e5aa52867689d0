// The one table of settings: name, documentation, unit, range and access for every field of every settings
// struct. It feeds --set, Python's properties, the JSON file and the reference documentation.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr {

struct Settings;
struct InferredSettings;
struct Style;

/// A setting's value in transit. Enumerations are strings, colours and vectors lists of numbers.
struct Value {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // GCC takes enumerators for names in the namespace.
    enum class State { given, automatic, follow };
#pragma GCC diagnostic pop
    using Data = std::variant<bool, double, std::string, std::vector<double>>;

    Data data;
    State state = State::given;  ///< automatic with `latched`: data hold the inferred value
    bool latched = false;

    bool operator==(const Value&) const = default;
};

/// A colormap is a text of parse_colormap(); its choices are the names.
enum class FieldType { boolean, integer, number, color, vector, text, choice, colormap };

/// What a field of a struct is: of the settings, or of a light.
struct FieldInfo {
    std::string name;  ///< "group.name" of a setting
    std::string doc;   ///< one sentence
    std::string unit;
    FieldType type = FieldType::number;
    bool can_be_automatic = false;
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    std::vector<std::string> choices;
    std::vector<size_t> sizes;  ///< allowed lengths of a vector
    bool whole = false;         ///< the number, or each of a vector's, is a whole one
    bool is_box = false;        ///< a vector of a box's minimum, then its maximum
};

template <class Owner>
struct FieldOf : FieldInfo {
    std::function<Value(const Owner&)> get;
    /// Sets an already checked value.
    std::function<void(Owner&, const Value&)> put;
    /// Whether two owners' members are equal, latched values included: without a Value, so quickly.
    std::function<bool(const Owner&, const Owner&)> same;
};

/// A field of the settings.
struct Field : FieldOf<Settings> {
    bool is_kept =
        true;  ///< an automatic value, once inferred, is kept, see latch(); else it is inferred anew
    std::function<Value(const InferredSettings&)> get_inferred;
    /// Copies the value. Throws std::logic_error where there is none.
    std::function<void(InferredSettings&, const Settings&)> copy;
};

/// All fields in the order of the reference.
const std::vector<Field>& fields();

/// Throws NameError with the nearest name for an unknown one.
const Field& field(std::string_view name);

/// Throws NameError or ArgumentError that says what was expected.
void set(Settings& settings, std::string_view name, const Value& value);
Value get(const Settings& settings, std::string_view name);
Value get(const InferredSettings& settings, std::string_view name);

/// Whether all fields are equal, latched values included.
bool are_equal(const Settings& a, const Settings& b);

/// Whether the data of a value are in the field's range, and finite.
bool is_valid(const Field& field, const Value& value);

/// The value in the form in which `put` takes it. Throws ArgumentError that says what was expected of the
/// setting, or, of another struct's field, of `owner` followed by its name ("light.", "light 'sun': ").
Value checked(const FieldInfo& field, const Value& value, std::string_view owner = {});

/// Throws the ArgumentError of checked() for what no Value holds, such as a list of texts. `given`: that, as
/// it is written.
[[noreturn]] void reject_value(const FieldInfo& field, std::string_view given, std::string_view owner = {});

/// The value written as on the command line: numbers separated by commas, '#rrggbb', true/false, 'auto',
/// 'follow', names and colours of colour maps.
Value parse_value(const FieldInfo& field, std::string_view text);
std::string to_text(const FieldInfo& field, const Value& value);

/// A field of an object's own style, by its name without "style.". Throws NameError or ArgumentError.
void set(Style& style, std::string_view name, const Value& value);
Value get(const Style& style, std::string_view name);
void set_from_text(Style& style, std::string_view name, std::string_view text);

/// Sets "group.name" from text as --set does.
void set_from_text(Settings& settings, std::string_view name, std::string_view text);

}  // namespace easypbr
