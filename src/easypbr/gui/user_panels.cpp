#include "easypbr/gui/user_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/gui/gui_scope.h"

namespace easypbr::gui {
namespace {

constexpr float panel_width = 280, gap = 12;

void error_text(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.93f, 0.36f, 0.33f, 1));
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

/// Calls a user's function; what it threw, as text.
std::string call(const PanelFunction& function, GuiState& state, const std::string& name) {
    const GuiPause pause;
    Widgets widgets(pause.context(), state, name);
    try {
        function(widgets);
        return {};
    } catch (const std::exception& error) {
        return error.what();
    } catch (...) {
        return "an exception that is no std::exception";
    }
}

}  // namespace

void UserPanels::add(const std::string& name, PanelFunction function) {
    if (name.empty()) throw ArgumentError("a panel needs a name");
    if (!function) throw ArgumentError(fmt::format("panel '{}': expected a function", name));
    if (Panel* known = find(name))
        *known = {name, std::move(function), true, {}};
    else
        panels_.push_back({name, std::move(function), true, {}});
}

void UserPanels::remove(const std::string& name) {
    if (!find(name)) throw NameError(fmt::format("no panel '{}'{}", name, did_you_mean(name, names())));
    std::erase_if(panels_, [&](const Panel& panel) { return panel.name == name; });
}

std::vector<std::string> UserPanels::names() const {
    std::vector<std::string> names;
    for (const Panel& panel : panels_) names.push_back(panel.name);
    return names;
}

std::map<std::string, std::string> UserPanels::errors() const {
    std::map<std::string, std::string> errors;
    for (const Panel& panel : panels_) errors[panel.name] = panel.error;
    return errors;
}

UserPanels::Panel* UserPanels::find(const std::string& name) {
    const auto found = std::ranges::find(panels_, name, &Panel::name);
    return found == panels_.end() ? nullptr : &*found;
}

void UserPanels::draw(GuiState& state) {
    const float top = ImGui::GetFrameHeight() + gap * state.scale;
    float x = (left_width + gap) * state.scale;
    const bool rescaled = std::exchange(scale_, state.scale) != state.scale;
    // By name, for functions may add and remove panels.
    for (const std::string& name : names()) {
        if (const Panel* panel = find(name); !panel || !panel->open) continue;
        draw_panel(state, name, x, top, rescaled);
        x += (panel_width + gap) * state.scale;
    }
}

void UserPanels::draw_panel(GuiState& state, const std::string& name, float x, float y, bool rescaled) {
    const float width = panel_width * state.scale;
    ImGui::SetNextWindowPos(ImVec2(x, y), rescaled ? ImGuiCond_Always : ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, float(state.size.y()) - y));
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;
    bool open = true;
    std::string error;
    PanelFunction function = find(name)->function;  // A copy: it may be replaced while it runs.
    if (ImGui::Begin((name + "##user").c_str(), &open, flags)) {
        error = call(function, state, name);
        if (!error.empty()) error_text(error);
    }
    ImGui::End();
    if (Panel* panel = find(name)) {
        panel->open &= open;
        panel->error = error;
    }
}

void UserPanels::menu() {
    if (panels_.empty()) return;
    ImGui::Separator();
    for (Panel& panel : panels_) ImGui::MenuItem(panel.name.c_str(), nullptr, &panel.open);
}

}  // namespace easypbr::gui
