#include "easypbr/remote/recorded_widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "easypbr/core/error.h"
#include "easypbr/remote/describe.h"

namespace easypbr::remote {
namespace {

using nlohmann::json;

std::optional<double> number_in(const std::string& text) {
    double number = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end || !std::isfinite(number)) return std::nullopt;
    return number;
}

/// sRGB as "#rrggbb".
std::optional<Vec3> color_in(const std::string& text) {
    unsigned bits = 0;
    const char* end = text.data() + text.size();
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    const auto [rest, error] = std::from_chars(text.data() + 1, end, bits, 16);
    if (error != std::errc() || rest != end) return std::nullopt;
    return Vec3(float(bits >> 16), float(bits >> 8 & 255), float(bits & 255)) / 255;
}

std::string hex_of(const Vec3& color) {
    const auto byte = [&](int c) { return int(std::lround(std::clamp(color[c], 0.0f, 1.0f) * 255)); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(0), byte(1), byte(2));
}

/// The lowest and the highest of each part, in this order; where there is none, what is not finite.
std::vector<float> thinned(std::span<const float> values, size_t most) {
    if (values.size() <= most) return {values.begin(), values.end()};
    std::vector<float> kept;
    const size_t parts = most / 2;
    for (size_t part = 0; part < parts; ++part) {
        float low = HUGE_VALF, high = -HUGE_VALF;
        for (size_t i = part * values.size() / parts; i < (part + 1) * values.size() / parts; ++i)
            if (std::isfinite(values[i])) low = std::min(low, values[i]), high = std::max(high, values[i]);
        kept.push_back(low);
        kept.push_back(high);
    }
    return kept;
}

}  // namespace

struct RecordedWidgets::Recorded {
    json list = json::array();
    bool beside = false;  ///< the next widget stands beside the last one
};

RecordedWidgets::RecordedWidgets(PanelMemory& memory)
    : memory_(memory), recorded_(std::make_unique<Recorded>()) {}

RecordedWidgets::~RecordedWidgets() = default;

json RecordedWidgets::take() {
    return std::move(recorded_->list);
}

WidgetPlace RecordedWidgets::place_of(const std::string& name) {
    return {name, used_[name]++};
}

std::optional<std::string> RecordedWidgets::edit_of(const WidgetPlace& place) {
    const auto found = memory_.edits.find(place);
    if (found == memory_.edits.end()) return std::nullopt;
    std::string edit = std::move(found->second);
    memory_.edits.erase(found);
    return edit;
}

void RecordedWidgets::add(const char* kind, const WidgetPlace& place, json widget) {
    const bool beside = std::exchange(recorded_->beside, false);
    if (recorded_->list.size() >= most_widgets) return;
    widget["type"] = kind;
    widget["name"] = place.first;
    if (place.second > 0) widget["use"] = place.second;
    if (beside) widget["beside"] = true;
    recorded_->list.push_back(std::move(widget));
}

void RecordedWidgets::text(const std::string& text) {
    add("text", {text, 0}, json::object());
}

void RecordedWidgets::separator() {
    add("separator", {}, json::object());
}

void RecordedWidgets::same_line() {
    recorded_->beside = true;
}

bool RecordedWidgets::section(const std::string& title, bool open) {
    const WidgetPlace place = place_of(title);
    if (const auto edit = edit_of(place)) memory_.open[place] = *edit == "true";
    const auto known = memory_.open.find(place);
    if (known != memory_.open.end()) open = known->second;
    add("section", place, {{"value", open}});
    return open;
}

bool RecordedWidgets::button(const std::string& name) {
    const WidgetPlace place = place_of(name);
    const bool clicked = edit_of(place).has_value();
    add("button", place, json::object());
    return clicked;
}

bool RecordedWidgets::checkbox(const std::string& name, bool& value) {
    const WidgetPlace place = place_of(name);
    const auto edit = edit_of(place);
    const bool changed = edit && (*edit == "true" || *edit == "false");
    if (changed) value = *edit == "true";
    add("checkbox", place, {{"value", value}});
    return changed;
}

bool RecordedWidgets::text_field(const std::string& name, std::string& value) {
    const WidgetPlace place = place_of(name);
    const auto edit = edit_of(place);
    if (edit) value = *edit;
    add("text_field", place, {{"value", value}});
    return edit.has_value();
}

bool RecordedWidgets::draw_slider(const std::string& name, double& value, double low, double high) {
    const WidgetPlace place = place_of(name);
    const auto edit = edit_of(place);
    const auto number = edit ? number_in(*edit) : std::nullopt;
    if (number) value = std::clamp(*number, low, high);
    add("slider", place, {{"value", value}, {"min", low}, {"max", high}});
    return number.has_value();
}

bool RecordedWidgets::draw_slider(const std::string& name, int& value, int low, int high) {
    const WidgetPlace place = place_of(name);
    const auto edit = edit_of(place);
    const auto number = edit ? number_in(*edit) : std::nullopt;
    if (number) value = int(std::lround(std::clamp(*number, double(low), double(high))));
    add("slider", place, {{"value", value}, {"min", low}, {"max", high}, {"whole", true}});
    return number.has_value();
}

bool RecordedWidgets::draw_number(const std::string& name, double& value) {
    const WidgetPlace place = place_of(name);
    const auto edit = edit_of(place);
    const auto number = edit ? number_in(*edit) : std::nullopt;
    if (number) value = *number;
    add("number", place, {{"value", value}});
    return number.has_value();
}

bool RecordedWidgets::draw_combo(const std::string& name, std::string& value,
                                 const std::vector<std::string>& choices) {
    const WidgetPlace place = place_of(name);
    const auto edit = edit_of(place);
    const bool changed = edit && std::ranges::count(choices, *edit) > 0;
    if (changed) value = *edit;
    add("combo", place, {{"value", value}, {"choices", choices}});
    return changed;
}

bool RecordedWidgets::draw_color(const std::string& name, Vec3& value) {
    const WidgetPlace place = place_of(name);
    const auto edit = edit_of(place);
    const auto color = edit ? color_in(*edit) : std::nullopt;
    if (color) value = *color;
    add("color", place, {{"value", hex_of(value)}});
    return color.has_value();
}

void RecordedWidgets::draw_plot(const std::string& name, std::span<const float> values, const Vec2& range) {
    json points = json::array();
    for (const float value : thinned(values, most_values))
        points.push_back(std::isfinite(value) ? json(value) : json(nullptr));
    json widget = {{"values", points}, {"min", range.x()}, {"max", range.y()}};
    if (!values.empty() && std::isfinite(values.back())) widget["last"] = values.back();
    add("plot", {name, 0}, std::move(widget));
}

void RecordedWidgets::draw_progress(double fraction, const std::string& text) {
    add("progress", {text, 0}, {{"value", fraction}});
}

std::optional<Value> RecordedWidgets::field(const std::string& name, const FieldInfo& info,
                                            const Value& value, const std::optional<Value>& inferred) {
    const WidgetPlace place = place_of(name);
    std::optional<Value> chosen;
    if (const auto edit = edit_of(place)) try {
            chosen = checked(info, parse_value(info, *edit));
        } catch (const Error& error) {
            problems_.emplace_back(error.what());
        }
    const Value& shown = chosen ? *chosen : value;
    const FieldText text = text_of(info, shown);
    json widget = {{"field", description_of(info)}, {"value", text.given}};
    if (!text.latched.empty()) widget["latched"] = text.latched;
    if (shown.state != Value::State::given && inferred) widget["latched"] = to_text(info, *inferred);
    add("field", place, std::move(widget));
    return chosen;
}

std::string panels_text(app::UserPanels& panels, std::map<std::string, PanelMemory>& memories) {
    json list = json::array();
    for (const std::string& name : panels.names()) {
        RecordedWidgets widgets(memories[name]);
        const std::string error = panels.call(name, widgets);
        memories[name].edits.clear();  // Of widgets that are no longer there.
        json panel = {{"name", name}, {"widgets", widgets.take()}};
        if (!error.empty()) panel["error"] = error;
        list.push_back(std::move(panel));
    }
    return json({{"kind", "panels"}, {"panels", list}}).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace easypbr::remote
