#include "easypbr/gui/user_panel_windows.h"

#include <imgui.h>

#include <utility>

#include "easypbr/gui/gui_scope.h"
#include "easypbr/gui/imgui_widgets.h"

namespace easypbr::gui {
namespace {

constexpr float user_panel_width = 280, user_panel_gap = 12;

void error_text(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.93f, 0.36f, 0.33f, 1));
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

}  // namespace

UserPanelWindows::Window& UserPanelWindows::window_of(const app::UserPanels& panels,
                                                      const std::string& name) {
    Window& window = windows_[name];
    if (const uint64_t revision = panels.revision(name); window.revision != revision)
        window = {true, revision};
    return window;
}

void UserPanelWindows::draw(GuiState& state) {
    const app::UserPanels& panels = state.live.panels();
    const float top = ImGui::GetFrameHeight() + user_panel_gap * state.screen.scale;
    float x = (left_width + user_panel_gap) * state.screen.scale;
    rescaled_ = std::exchange(scale_, state.screen.scale) != state.screen.scale;
    std::erase_if(windows_, [&](const auto& window) { return panels.revision(window.first) == 0; });
    // By name, for functions may add and remove panels.
    for (const std::string& name : panels.names()) {
        if (panels.revision(name) == 0 || !window_of(panels, name).open) continue;
        draw_panel(state, name, {x, top});
        x += (user_panel_width + user_panel_gap) * state.screen.scale;
    }
}

void UserPanelWindows::draw_panel(GuiState& state, const std::string& name, Vec2 at) {
    const float scale = state.screen.scale, bottom = float(state.screen.size.y());
    const float width = user_panel_width * scale;
    ImGui::SetNextWindowPos(ImVec2(at.x(), at.y()), rescaled_ ? ImGuiCond_Always : ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, bottom - at.y()));
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;
    bool open = true;
    if (ImGui::Begin((name + "##user").c_str(), &open, flags)) {
        std::string error;
        {
            const GuiPause pause;
            ImGuiWidgets widgets(pause.context(), scale, name);
            error = state.live.call_panel(name, widgets);
        }
        if (!error.empty()) error_text(error);
    }
    ImGui::End();
    window_of(state.live.panels(), name).open &= open;
}

void UserPanelWindows::menu(const app::UserPanels& panels) {
    if (panels.empty()) return;
    ImGui::Separator();
    for (const std::string& name : panels.names())
        ImGui::MenuItem(name.c_str(), nullptr, &window_of(panels, name).open);
}

}  // namespace easypbr::gui
