#include "easypbr/remote/tool_panels.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "easypbr/core/error.h"

namespace easypbr::remote {
namespace {

struct Tool {
    void (*draw)(RecordedWidgets&, ToolState&);
    bool changes_scene;
    bool names_files = false;
};

const std::map<std::string, Tool>& tools() {
    static const std::map<std::string, Tool> tools = {{"Object", {object_tool, true}},
                                                      {"Lights", {lights_tool, true}},
                                                      {"Camera path", {path_tool, false}},
                                                      {"Recording", {recording_tool, false}},
                                                      {"Files", {files_tool, true, true}}};
    return tools;
}

}  // namespace

bool ToolPanels::has(const std::string& name) const {
    const auto found = tools().find(name);
    return found != tools().end() && (whole_ || !found->second.changes_scene) &&
           (state_.files || !found->second.names_files);
}

void ToolPanels::edit(const SetWidget& message) {
    if (!has(message.panel)) throw ArgumentError(fmt::format("there is no panel '{}'", message.panel));
    memories_[message.panel].edits[{message.name, message.use}] = message.value;
}

std::string ToolPanels::recorded(const std::string& name) {
    PanelMemory& memory = memories_[name];
    RecordedWidgets widgets(memory);
    const auto notify = [&](const std::string& text) { state_.live.notifications().add(text, true); };
    try {
        tools().at(name).draw(widgets, state_);
    } catch (const Error& error) {
        notify(error.what());
    }
    for (const std::string& problem : widgets.problems()) notify(problem);
    memory.edits.clear();  // Of widgets that are no longer there.
    using nlohmann::json;
    return json({{"kind", "tool"}, {"name", name}, {"widgets", widgets.take()}})
        .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::vector<ToolText> ToolPanels::news() {
    std::vector<ToolText> news;
    for (const auto& [name, tool] : tools()) {
        if (!has(name)) continue;
        std::string text = recorded(name);
        std::string& told = told_[name];
        if (told == text) continue;
        told = std::move(text);
        news.push_back({told, !tool.names_files});
    }
    return news;
}

std::vector<ToolText> ToolPanels::told() const {
    std::vector<ToolText> texts;
    for (const auto& [name, text] : told_) texts.push_back({text, !tools().at(name).names_files});
    return texts;
}

}  // namespace easypbr::remote
