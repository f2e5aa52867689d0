#include <imgui.h>

#include <algorithm>
#include <set>

#include "easypbr/app/camera_text.h"
#include "easypbr/app/channels.h"
#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::gui {
namespace {

std::string group_of(const std::string& name) {
    return name.substr(0, name.find('.'));
}

/// A group's name as a heading.
std::string title_of(const std::string& group) {
    static const std::map<std::string, std::string> titles = {
        {"ssao", "Ambient occlusion"}, {"edl", "Eye-dome lighting"}, {"tonemap", "Tone and exposure"},
        {"image", "Picture"},          {"clip", "Clipping"},         {"material", "All materials"},
        {"style", "All styles"}};
    if (const auto known = titles.find(group); known != titles.end()) return known->second;
    std::string title = readable(group);
    title[0] = ascii::to_upper(title[0]);
    return title;
}

void try_set(GuiState& state, const std::string& name, const Value& value) {
    try {
        set(state.settings(), name, value);
    } catch (const Error& error) {
        state.notify(error.what(), true);
    }
}

}  // namespace

void settings_rows(GuiState& state, const std::string& prefix) {
    if (!begin_rows(prefix.c_str())) return;
    for (const Field& field : fields()) {
        if (!field.name.starts_with(prefix)) continue;
        std::optional<Value> inferred;
        if (state.live.picture().resolved())
            inferred = field.get_inferred(state.live.picture().resolved()->settings);
        field_row(field, field.get(state.settings()), inferred,
                  [&](const Value& value) { try_set(state, field.name, value); });
    }
    end_rows();
}

void effects_panel(GuiState& state) {
    static const std::set<std::string> elsewhere = {"camera", "environment", "background", "lights", "load"};
    static const std::set<std::string> open = {"tonemap", "ssao"};
    std::vector<std::string> groups;
    for (const Field& field : fields()) {
        const std::string group = group_of(field.name);
        if (!elsewhere.contains(group) && std::ranges::find(groups, group) == groups.end())
            groups.push_back(group);
    }
    for (const std::string& group : groups) {
        const ImGuiTreeNodeFlags flags =
            ImGuiTreeNodeFlags_SpanAvailWidth | (open.contains(group) ? ImGuiTreeNodeFlags_DefaultOpen : 0);
        if (!ImGui::TreeNodeEx(title_of(group).c_str(), flags)) continue;
        settings_rows(state, group + ".");
        ImGui::TreePop();
    }
}

void environment_panel(GuiState& state) {
    settings_rows(state, "environment.");
    ImGui::Spacing();
    dim_text("Background");
    settings_rows(state, "background.");
}

void camera_panel(GuiState& state) {
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (ImGui::Button("Fit (F)", ImVec2(half, 0))) state.live.navigation().ask_fit();
    ImGui::SameLine();
    if (ImGui::Button("Save (Ctrl+S)", ImVec2(half, 0))) state.live.wishes().save = true;
    if (ImGui::Button("Copy pose (Ctrl+C)", ImVec2(half, 0)))
        state.live.clipboard().write(app::camera_text(state.session(), state.screen.size));
    ImGui::SameLine();
    if (ImGui::Button("Paste pose (Ctrl+V)", ImVec2(half, 0))) try {
            app::apply_camera_text(state.live.clipboard().read(), state.settings());
        } catch (const Error& error) {
            state.notify(error.what(), true);
        }
    settings_rows(state, "camera.");
}

void channels_panel(GuiState& state) {
    const std::vector<std::string> names = app::channel_names();
    const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
    for (size_t i = 0; i < names.size(); ++i) {
        if (i % 3 != 0) ImGui::SameLine();
        const bool chosen = names[i] == state.live.channel;
        if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        const std::string label = readable(names[i] == "ambient_occlusion" ? "occlusion (ss)" : names[i]);
        if (ImGui::Button((label + "##" + names[i]).c_str(), ImVec2(width, 0))) state.live.channel = names[i];
        if (chosen) ImGui::PopStyleColor();
    }
}

}  // namespace easypbr::gui
