#include "easypbr/remote/messages.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "easypbr/core/ascii.h"

namespace easypbr::remote {
namespace {

using nlohmann::json;
using Kind = app::InputEvent::Kind;

constexpr double most_pixels = 1e5, most_seconds = 1e12, most_busy_s = 3600;
/// Bytes; names of objects and panels are the program's, and may be long.
constexpr size_t name_length = 256, text_length = 8192;

/// The members of a message, each asked for once.
class Members {
  public:
    explicit Members(const json& message) : message_(message) { known_.insert("kind"); }

    double number(const char* name, double low, double high) {
        const json& value = member(name);
        if (!value.is_number()) wrong(name, "a number");
        const double number = value.get<double>();
        if (!(number >= low && number <= high)) wrong(name, fmt::format("{} to {}", low, high));
        return number;
    }
    uint32_t count(const char* name) { return uint32_t(whole(name, 0, 0xffffffffLL)); }
    int side(const char* name, int most) { return int(whole(name, 1, most)); }
    bool flag(const char* name) {
        const json& value = member(name);
        if (!value.is_boolean()) wrong(name, "true or false");
        return value.get<bool>();
    }
    std::string text(const char* name, size_t most) {
        const json& value = member(name);
        if (!value.is_string()) wrong(name, "a text");
        const auto& text = value.get_ref<const std::string&>();
        if (text.size() > most) wrong(name, fmt::format("at most {} bytes", most));
        if (text.find('\0') != text.npos) wrong(name, "a text without zeros");
        return text;
    }
    template <class T>
    T one_of(const char* name, const std::map<std::string, T>& choices) {
        const auto found = choices.find(text(name, name_length));
        if (found == choices.end()) wrong(name, "one of those that the protocol names");
        return found->second;
    }
    /// Throws when there are members that nobody asked for.
    void end() const {
        for (const auto& [name, value] : message_.items())
            if (!known_.contains(name))
                throw ProtocolError(fmt::format("unknown member '{}'", name.substr(0, 40)));
    }

  private:
    const json& member(const char* name) {
        known_.insert(name);
        const auto found = message_.find(name);
        if (found == message_.end()) throw ProtocolError(fmt::format("member '{}' is missing", name));
        return *found;
    }
    int64_t whole(const char* name, int64_t low, int64_t high) {
        const json& value = member(name);
        // Unsigned numbers beyond the range of signed ones would become negative.
        const bool fits =
            value.is_number_integer() &&
            (!value.is_number_unsigned() || value.get<uint64_t>() <= uint64_t(0x7fffffffffffffffLL));
        if (!fits || value.get<int64_t>() < low || value.get<int64_t>() > high)
            wrong(name, fmt::format("a whole number, {} to {}", low, high));
        return value.get<int64_t>();
    }
    [[noreturn]] static void wrong(const char* name, const std::string& expected) {
        throw ProtocolError(fmt::format("member '{}': expected {}", name, expected));
    }

    const json& message_;
    std::set<std::string> known_;
};

Vec2i picture_size(Members& members, int most) {
    const int width = members.side("width", most), height = members.side("height", most);
    return {width, height};
}

Vec2d position_of(Members& members) {
    const double x = members.number("x", -most_pixels, most_pixels);
    return {x, members.number("y", -most_pixels, most_pixels)};
}

int key_of(Members& members) {
    static const std::map<std::string, int> others = {
        {"space", app::key::space}, {"escape", app::key::escape}, {"enter", app::key::enter}};
    const std::string name = members.text("key", name_length);
    const bool plain = name.size() == 1 && (ascii::is_upper(name[0]) || ascii::is_digit(name[0]));
    if (plain) return name[0];
    const auto found = others.find(name);
    if (found == others.end())
        throw ProtocolError("member 'key': expected a capital letter, a digit or a name");
    return found->second;
}

ClientMessage hello_of(Members& members) {
    const std::string token = members.text("token", 128);
    return Hello{token, picture_size(members, most_live_side)};
}

ClientMessage ack_of(Members& members) {
    const uint32_t frame = members.count("frame");
    const uint32_t chunk = members.count("chunk");
    return Ack{frame, chunk, members.number("busy", 0, most_busy_s)};
}

ClientMessage pointer_of(Members& members) {
    static const std::map<std::string, Kind> actions = {
        {"move", Kind::move}, {"press", Kind::press}, {"release", Kind::release}, {"wheel", Kind::scroll}};
    static const std::map<std::string, app::MouseButton> buttons = {{"left", app::MouseButton::left},
                                                                    {"right", app::MouseButton::right},
                                                                    {"middle", app::MouseButton::middle}};
    Input input;
    input.id = members.count("id");
    input.event.kind = members.one_of("action", actions);
    input.event.button = members.one_of("button", buttons);
    input.event.position = position_of(members);
    input.event.scroll = {0, members.number("wheel", -100, 100)};
    input.event.shift = members.flag("shift");
    input.event.time = members.number("time", 0, most_seconds);
    return input;
}

ClientMessage key_message_of(Members& members) {
    static const std::map<std::string, Kind> actions = {{"down", Kind::key_down}, {"up", Kind::key_up}};
    Input input;
    input.id = members.count("id");
    input.event.kind = members.one_of("action", actions);
    input.event.key = key_of(members);
    input.event.shift = members.flag("shift");
    return input;
}

ClientMessage blur_of(Members& members) {
    Input input;
    input.id = members.count("id");
    input.event.kind = Kind::focus_lost;
    return input;
}

ClientMessage turn_of(Members& members) {
    const uint32_t id = members.count("id");
    const double right = members.number("right", -360, 360);
    return Turn{id, right, members.number("up", -180, 180)};
}

ClientMessage resize_of(Members& members) {
    return Resize{picture_size(members, most_live_side)};
}

ClientMessage own_view_of(Members& members) {
    const bool own = members.flag("own");
    return OwnView{own, picture_size(members, most_live_side)};
}

ClientMessage pause_of(Members& members) {
    return Pause{members.flag("paused")};
}

ClientMessage decodes_of(Members& members) {
    return Decodes{members.flag("h264")};
}

ClientMessage set_of(Members& members) {
    const std::string name = members.text("name", name_length);
    return SetField{name, members.text("value", text_length)};
}

ClientMessage show_of(Members& members) {
    const std::string object = members.text("object", text_length);
    return ShowObject{object, members.flag("visible")};
}

ClientMessage select_of(Members& members) {
    return Select{members.text("object", text_length)};
}

ClientMessage pick_of(Members& members) {
    const uint32_t id = members.count("id");
    return PickAt{id, position_of(members)};
}

ClientMessage channel_of(Members& members) {
    return SetChannel{members.text("name", name_length)};
}

ClientMessage shot_of(Members& members) {
    const uint32_t id = members.count("id");
    const Vec2i size = picture_size(members, most_shot_side);
    if (int64_t(size.x()) * size.y() > most_shot_pixels)
        throw ProtocolError(fmt::format("a still: expected {} pixels at most", most_shot_pixels));
    return Shot{id, size};
}

ClientMessage camera_of(Members& members) {
    return SetCamera{members.text("text", text_length)};
}

SetWidget widget_in(Members& members) {
    SetWidget widget;
    widget.panel = members.text("panel", text_length);
    widget.name = members.text("name", text_length);
    widget.use = members.count("use");
    widget.value = members.text("value", text_length);
    return widget;
}

ClientMessage widget_of(Members& members) {
    return widget_in(members);
}

ClientMessage tool_of(Members& members) {
    SetWidget widget = widget_in(members);
    widget.tool = true;
    return widget;
}

ClientMessage animate_of(Members& members) {
    Animate animate;
    animate.number = members.count("number");
    animate.plays = members.flag("plays");
    animate.time_s = members.number("time", -most_seconds, most_seconds);
    animate.speed = members.number("speed", -100, 100);
    return animate;
}

ClientMessage act_of(Members& members) {
    using What = Act::What;
    static const std::map<std::string, What> names = {
        {"fit", What::fit},           {"undo", What::undo},           {"redo", What::redo},
        {"take", What::take_control}, {"leave", What::leave_control}, {"reset", What::reset}};
    return Act{members.one_of("what", names)};
}

using Reader = ClientMessage (*)(Members&);

const std::map<std::string, Reader>& readers() {
    static const std::map<std::string, Reader> readers = {
        {"hello", hello_of},   {"ack", ack_of},         {"pointer", pointer_of}, {"key", key_message_of},
        {"blur", blur_of},     {"turn", turn_of},       {"resize", resize_of},   {"view", own_view_of},
        {"pause", pause_of},   {"decodes", decodes_of}, {"set", set_of},         {"show", show_of},
        {"select", select_of}, {"pick", pick_of},       {"channel", channel_of}, {"shot", shot_of},
        {"camera", camera_of}, {"widget", widget_of},   {"tool", tool_of},       {"animate", animate_of},
        {"act", act_of}};
    return readers;
}

}  // namespace

ClientMessage parse_message(std::string_view text) {
    const json message = json::parse(text, nullptr, false);
    if (!message.is_object()) throw ProtocolError("expected a JSON object");
    const auto kind = message.find("kind");
    if (kind == message.end() || !kind->is_string()) throw ProtocolError("member 'kind' is missing");
    const auto reader = readers().find(kind->get_ref<const std::string&>());
    if (reader == readers().end()) throw ProtocolError("unknown kind of message");
    Members members(message);
    ClientMessage read = reader->second(members);
    members.end();
    return read;
}

}  // namespace easypbr::remote
