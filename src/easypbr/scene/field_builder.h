// How a member of a struct becomes a row of a table of fields. Used by fields_*.cpp and light_table.cpp
// alone.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/colormap.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::detail {

/// The double whose shortest decimal form is that of the float: 0.1 for 0.1f, so that texts and files stay
/// short. Turned back into a float it gives the same bits. The form of the largest float is larger than it:
/// that one stays as it is.
inline double shortest_double(float value) {
    char text[32];
    const char* const end = std::to_chars(text, text + sizeof text, value).ptr;
    double result = 0;
    std::from_chars(text, end, result);
    return std::abs(result) > double(std::numeric_limits<float>::max()) ? double(value) : result;
}

/// Names of an enumeration's values, in their order.
template <class Enum>
const std::vector<std::string>& enum_names();

inline Value::Data to_data(bool value) {
    return value;
}
inline Value::Data to_data(int value) {
    return double(value);
}
inline Value::Data to_data(float value) {
    return shortest_double(value);
}
inline Value::Data to_data(double value) {
    return value;
}
inline Value::Data to_data(const std::string& value) {
    return value;
}
inline Value::Data to_data(const NamedFile& value) {
    return value.name();
}
inline Value::Data to_data(const std::vector<double>& value) {
    return value;
}

inline Value::Data to_data(const Colormap& value) {
    return value.text();
}

template <class Scalar, int Rows>
Value::Data to_data(const Eigen::Matrix<Scalar, Rows, 1>& value) {
    std::vector<double> numbers;
    for (Scalar number : value) numbers.push_back(std::get<double>(to_data(number)));
    return numbers;
}

/// A number for what is none of the enumerators: no choice has that name, see checked().
template <class Enum>
requires std::is_enum_v<Enum> Value::Data to_data(Enum value) {
    const auto& names = enum_names<Enum>();
    return size_t(value) < names.size() ? names[size_t(value)] : std::to_string(int(value));
}

inline void from_data(const Value::Data& data, bool& value) {
    value = std::get<bool>(data);
}
inline void from_data(const Value::Data& data, int& value) {
    value = int(std::get<double>(data));
}
inline void from_data(const Value::Data& data, float& value) {
    value = float(std::get<double>(data));
}
inline void from_data(const Value::Data& data, double& value) {
    value = std::get<double>(data);
}
inline void from_data(const Value::Data& data, std::string& value) {
    value = std::get<std::string>(data);
}
inline void from_data(const Value::Data& data, NamedFile& value) {
    value = std::get<std::string>(data);
}
inline void from_data(const Value::Data& data, std::vector<double>& value) {
    value = std::get<std::vector<double>>(data);
}

inline void from_data(const Value::Data& data, Colormap& value) {
    value = parse_colormap(std::get<std::string>(data));
}

template <class Scalar, int Rows>
void from_data(const Value::Data& data, Eigen::Matrix<Scalar, Rows, 1>& value) {
    const auto& numbers = std::get<std::vector<double>>(data);
    for (int i = 0; i < Rows; ++i) value[i] = Scalar(numbers[size_t(i)]);
}

template <class Enum>
requires std::is_enum_v<Enum>
void from_data(const Value::Data& data, Enum& value) {
    const auto& names = enum_names<Enum>();
    value = Enum(std::find(names.begin(), names.end(), std::get<std::string>(data)) - names.begin());
}

template <class T>
Value to_value(const T& member) {
    return {to_data(member)};
}

template <class T>
Value to_value(const Auto<T>& member) {
    Value value;
    if (member.value()) value.data = to_data(*member);
    value.state = member.is_pinned()   ? Value::State::given
                  : member.is_follow() ? Value::State::follow
                                       : Value::State::automatic;
    value.latched = value.state == Value::State::automatic && member.value().has_value();
    return value;
}

template <class T>
Value to_value(const Override<T>& member) {
    if (!member.value()) return {{}, Value::State::automatic};
    return {to_data(*member)};
}

template <class T>
void from_value(const Value& value, T& member) {
    from_data(value.data, member);
}

template <class T>
void from_value(const Value& value, Auto<T>& member) {
    member = value.state == Value::State::follow ? Auto<T>(follow) : Auto<T>(automatic);
    if (value.state != Value::State::given && !value.latched) return;
    T data{};
    from_data(value.data, data);
    if (value.latched)
        member.latch(data);
    else
        member = Auto<T>(data);
}

template <class T>
void from_value(const Value& value, Override<T>& member) {
    member = automatic;
    if (value.state != Value::State::given) return;
    T data{};
    from_data(value.data, data);
    member = data;
}

/// From settings to inferred ones.
template <class T>
void copy_value(const std::string& /*name*/, const T& from, T& to) {
    to = from;
}

template <class T>
void copy_value(const std::string& name, const Auto<T>& from, T& to) {
    if (!from.value()) throw std::logic_error("setting '" + name + "' was not inferred");
    to = *from;
}

template <class T>
struct Unwrapped {
    using type = T;
    static constexpr bool is_auto = false;
};
template <class T>
struct Unwrapped<Auto<T>> {
    using type = T;
    static constexpr bool is_auto = true;
};
template <class T>
struct Unwrapped<Override<T>> {
    using type = T;
    static constexpr bool is_auto = true;
};

/// Type, choices, lengths and the range that the member itself can hold.
template <class T>
void describe(FieldInfo& field) {
    if constexpr (std::is_same_v<T, bool>) {
        field.type = FieldType::boolean;
    } else if constexpr (std::is_enum_v<T>) {
        field.type = FieldType::choice;
        field.choices = enum_names<T>();
    } else if constexpr (std::is_same_v<T, Colormap>) {
        field.type = FieldType::colormap;
        field.choices = colormap_names();
    } else if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, NamedFile>) {
        field.type = FieldType::text;
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
        field.type = FieldType::vector;
    } else if constexpr (std::is_arithmetic_v<T>) {
        field.type = std::is_integral_v<T> ? FieldType::integer : FieldType::number;
        field.whole = std::is_integral_v<T>;
        field.min = double(std::numeric_limits<T>::lowest());
        field.max = double(std::numeric_limits<T>::max());
    } else {
        describe<typename T::Scalar>(field);
        field.type = FieldType::vector;
        field.sizes = {size_t(T::RowsAtCompileTime)};
    }
}

/// Access to a member by its path, in settings and in inferred ones.
#define EASYPBR_AT(path)          \
    [](auto& settings) -> auto& { \
        return settings.path;     \
    }

inline constexpr double unlimited = std::numeric_limits<double>::infinity();
/// Below any length that occurs, above zero.
inline constexpr double positive = 1e-30;

struct Range {
    double min = -unlimited, max = unlimited;
};

/// Access by plain functions: what is compiled for a field then depends on its types alone.
template <class Member, class Inferred>
struct Place {
    Member& (*of_settings)(Settings&);
    const Member& (*of_const_settings)(const Settings&);
    Inferred& (*of_inferred)(InferredSettings&);
    const Inferred& (*of_const_inferred)(const InferredSettings&);

    Member& operator()(Settings& settings) const { return of_settings(settings); }
    const Member& operator()(const Settings& settings) const { return of_const_settings(settings); }
    Inferred& operator()(InferredSettings& settings) const { return of_inferred(settings); }
    const Inferred& operator()(const InferredSettings& settings) const { return of_const_inferred(settings); }
};

template <class Access>
auto place_of(Access access) {
    using Member = std::remove_cvref_t<decltype(access(std::declval<Settings&>()))>;
    using Inferred = std::remove_cvref_t<decltype(access(std::declval<InferredSettings&>()))>;
    if constexpr (std::is_empty_v<Access>)
        return Place<Member, Inferred>{
            [](Settings& settings) -> Member& { return Access{}(settings); },
            [](const Settings& settings) -> const Member& { return Access{}(settings); },
            [](InferredSettings& settings) -> Inferred& { return Access{}(settings); },
            [](const InferredSettings& settings) -> const Inferred& { return Access{}(settings); }};
    else
        return access;
}

/// Fills what the owner's type says of a field.
template <class Owner, class Access>
void make(FieldOf<Owner>& field, std::string_view name, Access access, std::string_view doc,
          std::string_view unit, Range range) {
    using Member = std::remove_cvref_t<decltype(access(std::declval<Owner&>()))>;
    field.name = name;
    field.doc = doc;
    field.unit = unit;
    describe<typename Unwrapped<Member>::type>(field);
    field.can_be_automatic = Unwrapped<Member>::is_auto;
    field.min = std::max(field.min, range.min);
    field.max = std::min(field.max, range.max);
    field.get = [access](const Owner& owner) { return to_value(access(owner)); };
    field.put = [access](Owner& owner, const Value& value) { from_value(value, access(owner)); };
    field.same = [access](const Owner& a, const Owner& b) { return access(a) == access(b); };
}

/// The same for one of all kinds of access that have the same types.
template <class Place>
Field made(Place place, std::string_view name, std::string_view doc, std::string_view unit, Range range) {
    Field field;
    make(field, name, place, doc, unit, range);
    field.get_inferred = [place](const InferredSettings& settings) { return to_value(place(settings)); };
    field.copy = [place, name = field.name](InferredSettings& to, const Settings& from) {
        copy_value(name, place(from), place(to));
    };
    return field;
}

template <class Access>
Field make(std::string_view name, Access access, std::string_view doc, std::string_view unit = {},
           Range range = {}) {
    return made(place_of(access), name, doc, unit, range);
}

template <class Access>
Field color(std::string_view name, Access access, std::string_view doc) {
    Field field = make(name, access, doc, "sRGB", {0, 1});
    field.type = FieldType::color;
    return field;
}

inline Field with_choices(Field field, std::vector<std::string> choices) {
    field.type = FieldType::choice;
    field.choices = std::move(choices);
    return field;
}

/// A field that is inferred for every image anew.
inline Field not_kept(Field field) {
    field.is_kept = false;
    return field;
}

inline Field with_sizes(Field field, std::vector<size_t> sizes) {
    field.sizes = std::move(sizes);
    return field;
}

/// A box's minimum, then its maximum, or nothing.
inline Field with_box(Field field) {
    field.sizes = {0, 6};
    field.is_box = true;
    return field;
}

using Table = std::vector<Field>;

}  // namespace easypbr::detail
