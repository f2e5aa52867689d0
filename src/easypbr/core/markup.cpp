#include "easypbr/core/markup.h"

#include <map>
#include <nlohmann/json.hpp>

namespace easypbr {

std::string valid_utf8(const std::string& text) {
    using Json = nlohmann::json;
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

std::string markup_escaped(std::string_view text) {
    static const std::map<char, std::string_view> references{
        {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
    std::string out;
    for (const char c : text) {
        const auto reference = references.find(c);
        out += reference == references.end() ? std::string_view(&c, 1) : reference->second;
    }
    return out;
}

}  // namespace easypbr
