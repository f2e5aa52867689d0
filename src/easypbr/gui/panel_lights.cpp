#include <imgui.h>

#include "easypbr/core/color.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"

namespace easypbr::gui {
namespace {

/// A button that selects a light, so that it can be moved in the scene.
void select_button(GuiState& state, const std::string& name) {
    const bool chosen = state.light == name;
    if (ImGui::Button(chosen ? "Stop moving" : "Move in the scene", ImVec2(-FLT_MIN, 0))) {
        state.light = chosen ? "" : name;
        state.object.clear();
    }
}

void studio_light(GuiState& state, const std::string& name, const char* title) {
    if (!ImGui::TreeNodeEx(title, ImGuiTreeNodeFlags_SpanAvailWidth)) return;
    select_button(state, name);
    settings_rows(state, "lights." + name + ".");
    ImGui::TreePop();
}

bool direction_row(const char* name, Vec3& value) {
    begin_row(name);
    ImGui::PushID(name);
    const bool changed = ImGui::DragFloat3("##vector", value.data(), 0.01f, 0, 0, "%.3g");
    ImGui::PopID();
    return changed;
}

void scene_light(GuiState& state, const std::string& name) {
    if (!ImGui::TreeNodeEx(name.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth)) return;
    Light light = state.session.scene().light(name);
    if (light.type != LightType::directional) select_button(state, name);
    bool changed = false;
    if (begin_rows("light", false)) {
        begin_row("enabled");
        changed |= ImGui::Checkbox("##enabled", &light.enabled);
        begin_row("intensity", light.type == LightType::directional ? "lux" : "candela");
        changed |= ImGui::DragFloat("##intensity", &light.intensity, std::max(light.intensity, 1e-3f) * 0.01f,
                                    0, 1e9f, "%.3g", ImGuiSliderFlags_AlwaysClamp);
        begin_row("color");
        Vec3 color = srgb_from_linear(light.color);
        if (ImGui::ColorEdit3("##color", color.data(),
                              ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoInputs)) {
            light.color = linear_from_srgb(color);
            changed = true;
        }
        if (light.type != LightType::directional) changed |= direction_row("position", light.position);
        if (light.type != LightType::point) {
            Vec3 direction = light.direction;
            if (direction_row("direction", direction) && direction.norm() > 1e-6f) {
                light.direction = direction;
                changed = true;
            }
        }
        begin_row("casts shadows");
        changed |= ImGui::Checkbox("##shadows", &light.casts_shadows);
        end_rows();
    }
    if (changed) state.session.scene().set_light(name, light);
    ImGui::TreePop();
}

}  // namespace

void lights_panel(GuiState& state) {
    if (begin_rows("factor", false)) {
        const Field& factor = field("lights.intensity");
        field_row(factor, factor.get(state.settings()), std::nullopt,
                  [&](const Value& value) { factor.put(state.settings(), value); });
        end_rows();
    }
    studio_light(state, "key", "Key");
    studio_light(state, "fill", "Fill");
    studio_light(state, "rim", "Rim");
    for (const std::string& name : state.session.scene().light_names()) scene_light(state, name);
}

}  // namespace easypbr::gui
