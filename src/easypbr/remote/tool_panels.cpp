#include "easypbr/remote/tool_panels.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "easypbr/core/error.h"

namespace easypbr::remote {
namespace {

using Tool = void (*)(RecordedWidgets&, ToolState&);

const std::map<std::string, Tool>& tools() {
    static const std::map<std::string, Tool> tools = {{"Object", object_tool},
                                                      {"Lights", lights_tool},
                                                      {"Camera path", path_tool},
                                                      {"Recording", recording_tool}};
    return tools;
}

}  // namespace

void ToolPanels::edit(const SetWidget& message) {
    if (!tools().contains(message.panel))
        throw ArgumentError(fmt::format("there is no panel '{}'", message.panel));
    memories_[message.panel].edits[{message.name, message.use}] = message.value;
}

std::string ToolPanels::recorded(const std::string& name) {
    PanelMemory& memory = memories_[name];
    RecordedWidgets widgets(memory);
    const auto notify = [&](const std::string& text) { state_.live.notifications().add(text, true); };
    try {
        tools().at(name)(widgets, state_);
    } catch (const Error& error) {
        notify(error.what());
    }
    for (const std::string& problem : widgets.problems()) notify(problem);
    memory.edits.clear();  // Of widgets that are no longer there.
    using nlohmann::json;
    return json({{"kind", "tool"}, {"name", name}, {"widgets", widgets.take()}})
        .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::vector<std::string> ToolPanels::news() {
    std::vector<std::string> news;
    for (const auto& [name, tool] : tools()) {
        std::string text = recorded(name);
        std::string& told = told_[name];
        if (told == text) continue;
        told = std::move(text);
        news.push_back(told);
    }
    return news;
}

std::vector<std::string> ToolPanels::told() const {
    std::vector<std::string> texts;
    for (const auto& [name, text] : told_) texts.push_back(text);
    return texts;
}

}  // namespace easypbr::remote
