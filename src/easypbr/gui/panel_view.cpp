#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "easypbr/app/output.h"
#include "easypbr/app/status_text.h"
#include "easypbr/app/view_point.h"
#include "easypbr/gui/item_places.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"
#include "easypbr/io/settings/presets.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::gui {
namespace {

struct KeyLine {
    const char *keys, *what;
};
constexpr KeyLine key_lines[] = {{"Left drag", "turn about the target"},
                                 {"Right or middle drag", "move sideways"},
                                 {"Wheel", "zoom to the pointer"},
                                 {"Click", "select an object"},
                                 {"Double click", "turn about the point"},
                                 {"W A S D, Q E", "fly; with Shift faster"},
                                 {"F", "fit all into the picture"},
                                 {"T  R  Y", "move, turn, scale the object"},
                                 {"H", "hide or show the panels"},
                                 {"F1 to F11", "hide or show one panel"},
                                 {"K", "key of the camera path"},
                                 {"Ctrl+C  Ctrl+V", "camera to and from the clipboard"},
                                 {"Ctrl+Z  Ctrl+Y", "undo, redo (or Ctrl+Shift+Z)"},
                                 {"Ctrl+S", "save the settings"},
                                 {"?", "this list"},
                                 {"Escape", "close the list or menu, or the window"}};

void preset_menu(GuiState& state) {
    const bool is_open = ImGui::BeginMenu("Preset");
    note_place("Menu/preset");
    if (!is_open) return;
    for (const std::string& name : io::preset_names()) {
        if (ImGui::MenuItem(readable(name).c_str())) app::apply_preset(state.session(), name);
        note_place("Menu/preset " + name);
    }
    ImGui::EndMenu();
}

}  // namespace

void statistics_panel(GuiState& state) {
    const app::LiveStatistics& now = state.live.picture().statistics();
    if (!ImGui::BeginTable("statistics", 2,
                           ImGuiTableFlags_NoSavedSettings | ImGuiTableFlags_SizingStretchSame))
        return;
    const auto line = [](const std::string& name, const std::string& value) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name.c_str());
        ImGui::TableNextColumn();
        const float gap = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(value.c_str()).x;
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(gap, 0.0f));
        ImGui::TextUnformatted(value.c_str());
    };
    line("frame", fmt::format("{:.1f} ms", now.frame_seconds * 1e3));
    line("picture", fmt::format("{} x {}", now.size.x(), now.size.y()));
    line("frames", fmt::format("{} of {}", now.frames, now.total));
    for (const auto& [pass, ms] : now.passes) line("  " + pass, fmt::format("{:.1f} ms", ms));
    ImGui::EndTable();
}

void menu_bar(GuiState& state) {
    if (!ImGui::BeginMainMenuBar()) return;
    if (ImGui::BeginMenu("View")) {
        for (int i = 0; i < panel_count; ++i)
            ImGui::MenuItem(panel_name(Panel(i)), fmt::format("F{}", i + 1).c_str(),
                            &state.panels.open[size_t(i)]);
        if (state.own_menu) state.own_menu();
        ImGui::Separator();
        ImGui::MenuItem("All panels", "H", &state.panels.shown);
        bool light = state.screen.theme == Theme::light;
        if (ImGui::MenuItem("Light theme", nullptr, &light))
            state.screen.theme = light ? Theme::light : Theme::dark;
        if (ImGui::BeginMenu("Size of the panels")) {
            for (const int percent : {75, 100, 125, 150, 200})
                if (const float scale = float(percent) / 100; ImGui::MenuItem(
                        fmt::format("{} %", percent).c_str(), nullptr, state.screen.panel_scale == scale))
                    state.screen.panel_scale = scale;
            ImGui::EndMenu();
        }
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Edit")) {
        if (ImGui::MenuItem("Undo", "Ctrl+Z", false, state.live.edits().can_undo()))
            state.live.edits().undo();
        if (ImGui::MenuItem("Redo", "Ctrl+Y", false, state.live.edits().can_redo()))
            state.live.edits().redo();
        ImGui::EndMenu();
    }
    preset_menu(state);
    if (ImGui::BeginMenu("Help")) {
        ImGui::MenuItem("Keys", "?", &state.panels.keys);
        ImGui::EndMenu();
    }
    const app::LiveStatistics& now = state.live.picture().statistics();
    const std::string text = fmt::format("{} x {}   {:.0f} ms   {} / {}", now.size.x(), now.size.y(),
                                         now.frame_seconds * 1e3, now.frames, now.total);
    const float x = ImGui::GetWindowWidth() - ImGui::CalcTextSize(text.c_str()).x - 24 * state.screen.scale;
    if (x > ImGui::GetCursorPosX()) {
        ImGui::SameLine(x);
        dim_text(text);
    }
    ImGui::EndMainMenuBar();
}

void keys_window(GuiState& state) {
    if (!state.panels.keys) return;
    ImGui::SetNextWindowPos(ImVec2(float(state.screen.size.x()) / 2, float(state.screen.size.y()) / 2),
                            ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    const ImGuiWindowFlags flags =
        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;
    if (ImGui::Begin("Keys and mouse", &state.panels.keys, flags) && ImGui::BeginTable("keys", 2)) {
        for (const KeyLine& line : key_lines) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.keys);
            ImGui::TableNextColumn();
            dim_text(line.what);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void status_line(GuiState& state) {
    const std::optional<app::Pick>& pick = state.live.picture().hovered();
    const ResolvedSettings* drawn = state.live.picture().resolved();
    if (!pick || !drawn) return;
    const Vec2d pitch = app::pixel_pitch(drawn->camera, state.live.size(), pick->depth);
    const std::string text =
        app::status_text(*pick, state.session().scene().origin(), pitch.cwiseAbs().minCoeff());
    const float pad = 6 * state.screen.scale, width = ImGui::CalcTextSize(text.c_str()).x;
    const float x = (float(state.screen.size.x()) - width) / 2;
    const float y = float(state.screen.size.y()) - ImGui::GetTextLineHeight() - 2 * pad;
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled(ImVec2(x - 2 * pad, y - pad),
                       ImVec2(x + width + 2 * pad, float(state.screen.size.y()) - pad),
                       ImGui::GetColorU32(ImGuiCol_WindowBg), 4 * state.screen.scale);
    list.AddText(ImVec2(x, y), ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

void notifications(GuiState& state) {
    float bottom = float(state.screen.size.y()) - 40 * state.screen.scale;
    const float pad = 8 * state.screen.scale,
                wrap = std::min(0.5f * float(state.screen.size.x()), 620 * state.screen.scale);
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    for (auto n = state.live.notifications().list().rbegin(); n != state.live.notifications().list().rend();
         ++n) {
        const ImVec2 size = ImGui::CalcTextSize(n->text.c_str(), nullptr, false, wrap);
        const ImVec2 from((float(state.screen.size.x()) - size.x) / 2, bottom - size.y);
        const ImU32 color = n->is_error ? IM_COL32(168, 52, 48, 240) : ImGui::GetColorU32(ImGuiCol_WindowBg);
        list.AddRectFilled(ImVec2(from.x - pad, from.y - pad),
                           ImVec2(from.x + size.x + pad, from.y + size.y + pad), color,
                           4 * state.screen.scale);
        list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), from,
                     n->is_error ? IM_COL32_WHITE : ImGui::GetColorU32(ImGuiCol_Text), n->text.c_str(),
                     nullptr, wrap);
        bottom = from.y - 2.5f * pad;
    }
}

}  // namespace easypbr::gui
