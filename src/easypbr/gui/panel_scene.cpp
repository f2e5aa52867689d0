#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <set>

#include "easypbr/app/vertex_edits.h"
#include "easypbr/core/color.h"
#include "easypbr/gui/imgui_widgets.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::gui {
namespace {

/// "46 356 vertices, 15 452 faces"
std::string count_text(Eigen::Index count) {
    std::string digits = std::to_string(count), text;
    for (size_t i = 0; i < digits.size(); ++i) {
        if (i && (digits.size() - i) % 3 == 0) text += "\xe2\x80\xaf";
        text += digits[i];
    }
    return text;
}

void node_row(GuiState& state, const Mesh& node, const std::string& path, const std::string& name,
              int depth) {
    require_mesh_depth(depth);
    const auto data = node.snapshot();
    ImGui::PushID(path.c_str());
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGuiTreeNodeFlags flags = ImGuiTreeNodeFlags_SpanAvailWidth | ImGuiTreeNodeFlags_OpenOnArrow;
    if (data->children.empty()) flags |= ImGuiTreeNodeFlags_Leaf | ImGuiTreeNodeFlags_NoTreePushOnOpen;
    if (depth < 2) flags |= ImGuiTreeNodeFlags_DefaultOpen;
    if (path == state.selection().object) flags |= ImGuiTreeNodeFlags_Selected;
    ImGui::AlignTextToFramePadding();
    const bool open = ImGui::TreeNodeEx("node", flags, "%s", name.empty() ? "(unnamed)" : name.c_str());
    if (ImGui::IsItemClicked() && !ImGui::IsItemToggledOpen()) {
        state.selection().object = state.selection().object == path ? "" : path;
        state.selection().light.clear();
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s\n%s vertices, %s faces", path.c_str(), count_text(data->V.rows()).c_str(),
                          count_text(data->F.rows()).c_str());
    ImGui::TableNextColumn();
    bool visible = data->style.visible.value_or(true);
    if (ImGui::Checkbox("##visible", &visible)) change_look(state, path, "style.visible", {visible});
    note_place("Scene/visible " + path);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", visible ? "Hide" : "Show");
    if (open && !data->children.empty()) {
        for (size_t i = 0; i < data->children.size(); ++i) {
            ImGui::PushID(int(i));
            const Mesh& child = data->children[i];
            node_row(state, child, path + "/" + child.name(), child.name(), depth + 1);
            ImGui::PopID();
        }
        ImGui::TreePop();
    }
    ImGui::PopID();
}

void color_row(const char* name, Vec3 linear, const std::function<void(const Vec3&)>& put) {
    begin_row(name);
    const Vec3 shown = srgb_from_linear(linear);
    float rgb[3] = {shown.x(), shown.y(), shown.z()};
    ImGui::PushID(name);
    if (ImGui::ColorEdit3("##color", rgb, ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoInputs))
        put(linear_from_srgb(Vec3(rgb[0], rgb[1], rgb[2])));
    ImGui::PopID();
}

/// A slider of one number of the first material.
void number_row(GuiState& state, const char* name, const Material& material, float Material::*member,
                float low, float high) {
    begin_row(readable(name));
    float value = material.*member;
    ImGui::PushID(name);
    if (ImGui::SliderFloat("##number", &value, low, high, "%.3g", ImGuiSliderFlags_AlwaysClamp))
        change_look(state, state.selection().object, std::string("material.") + name, {double(value)});
    ImGui::PopID();
}

void material_rows(GuiState& state, const Mesh& mesh) {
    if (!begin_rows("material", false)) return;
    const Material material = mesh.material();
    using M = Material;
    const auto put_color = [&](const char* property) {
        return [&state, property](const Vec3& color) {
            const std::vector<double> linear = {color[0], color[1], color[2]};
            change_look(state, state.selection().object, property, {linear});
        };
    };
    color_row("base color", material.base_color, put_color("material.base_color"));
    number_row(state, "metallic", material, &M::metallic, 0, 1);
    number_row(state, "roughness", material, &M::roughness, 0, 1);
    number_row(state, "opacity", material, &M::opacity, 0, 1);
    color_row("emissive", material.emissive.cwiseMin(1.0f), put_color("material.emissive"));
    number_row(state, "clearcoat", material, &M::clearcoat, 0, 1);
    number_row(state, "clearcoat_roughness", material, &M::clearcoat_roughness, 0, 1);
    number_row(state, "transmission", material, &M::transmission, 0, 1);
    number_row(state, "ior", material, &M::ior, 1, 3);
    number_row(state, "dispersion", material, &M::dispersion, 0, 10);
    number_row(state, "iridescence", material, &M::iridescence, 0, 1);
    number_row(state, "anisotropy", material, &M::anisotropy, 0, 1);
    end_rows();
}

void style_rows(GuiState& state, const Mesh& mesh) {
    if (!begin_rows("style")) return;
    const Style style = mesh.style();
    const std::string prefix = "style.";
    for (const Field& field : fields()) {
        if (!field.name.starts_with(prefix)) continue;
        const std::string name = field.name.substr(prefix.size());
        field_row(field, get(style, name), std::nullopt, [&](const Value& value) {
            change_look(state, state.selection().object, field.name, value);
        });
    }
    end_rows();
}

}  // namespace

void scene_panel(GuiState& state) {
    const std::vector<std::string> names = state.session().scene().names();
    if (names.empty()) {
        dim_text("Nothing is shown yet: drop a file on the window.");
        return;
    }
    // As high as its rows, whose number is one frame late when a node is opened.
    const float row = ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    const float height = std::min(0.4f * float(state.screen.size.y()),
                                  float(std::max(state.panels.tree_rows, int(names.size()))) * row);
    if (!ImGui::BeginTable("tree", 2, ImGuiTableFlags_ScrollY | ImGuiTableFlags_NoSavedSettings,
                           ImVec2(0, height)))
        return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("seen", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFrameHeight());
    for (const std::string& name : names) node_row(state, state.session().scene().get(name), name, name, 0);
    state.panels.tree_rows = ImGui::TableGetRowIndex() + 1;
    ImGui::EndTable();
}

void object_panel(GuiState& state) {
    const std::optional<Mesh> mesh = app::node_named(state.session().scene(), state.selection().object);
    if (!mesh) {
        dim_text("Click an object to select it.");
        return;
    }
    const auto data = mesh->snapshot();
    ImGui::TextUnformatted(state.selection().object.c_str());
    dim_text(fmt::format("{} vertices, {} faces", count_text(data->V.rows()), count_text(data->F.rows())));
    const char* labels[] = {"Move (T)", "Turn (R)", "Scale (Y)"};
    const float third = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
    for (int i = 0; i < 3; ++i) {
        if (i) ImGui::SameLine();
        const bool chosen = int(state.manipulator.handle) == i;
        if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        if (ImGui::Button(labels[i], ImVec2(third, 0))) state.manipulator.handle = Handle(i);
        if (chosen) ImGui::PopStyleColor();
    }
    ImGuiWidgets widgets(ImGui::GetCurrentContext(), state.screen.scale, "object");
    app::vertex_tool(widgets, state.live);
    if (ImGui::TreeNodeEx("Material", ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_SpanAvailWidth)) {
        material_rows(state, *mesh);
        ImGui::TreePop();
    }
    if (ImGui::TreeNodeEx("Style", ImGuiTreeNodeFlags_SpanAvailWidth)) {
        style_rows(state, *mesh);
        ImGui::TreePop();
    }
}

}  // namespace easypbr::gui
