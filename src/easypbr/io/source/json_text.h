// JSON from text, with messages that name the place of a mistake.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "easypbr/core/error.h"
#include "easypbr/io/source/json_depth.h"

namespace easypbr::io {

/// What stands where a parser stopped, "line 2, column 15: expected JSON, got '}'"; `read` counts the bytes
/// that it had read, that of the mistake among them.
std::string json_mistake(std::string_view text, size_t read);

/// The value of a text, as nlohmann::json or nlohmann::ordered_json. Throws FormatError, "cannot read NAME,
/// line 2, ...", also where JSON is nested too deep or a number is beyond float64.
template <class Json>
Json parse_json(std::string_view text, const std::string& name) {
    check_json_depth(text, name);
    try {
        return Json::parse(text);
    } catch (const typename Json::parse_error& error) {
        throw FormatError(fmt::format("cannot read {}, {}", name, json_mistake(text, error.byte)));
    } catch (const typename Json::out_of_range&) {
        throw FormatError(fmt::format("cannot read {}: a number is beyond what float64 holds", name));
    }
}

}  // namespace easypbr::io
