#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "easypbr/core/color.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"

namespace easypbr::gui {
namespace {

/// A button that selects a light, so that it can be moved in the scene.
void select_button(GuiState& state, const std::string& name) {
    const bool chosen = state.selection().light == name;
    const bool pressed = ImGui::Button(chosen ? "Stop moving" : "Move in the scene", ImVec2(-FLT_MIN, 0));
    note_place("Lights/move " + name);
    if (pressed) {
        state.selection().light = chosen ? "" : name;
        state.selection().object.clear();
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

/// Half the view's distance beside, above and before the target, as bright there as 3 lux.
Light new_light(GuiState& state) {
    const app::ViewPoint view = state.session().view_point(state.screen.size);
    Light light;
    const Vec3d offset = view.camera.T_world_cam.linear() * Vec3d(0.5, 0.5, 0.5) * view.distance();
    light.position = (view.target + offset).cast<float>();
    light.intensity = float(3 * offset.squaredNorm());
    return light;
}

void add_button(GuiState& state) {
    if (!named_button("Lights", "Add a light", -FLT_MIN)) return;
    const std::vector<std::string> names = state.session().scene().light_names();
    std::string name = "light";
    for (int number = 2; std::ranges::find(names, name) != names.end(); ++number)
        name = fmt::format("light-{}", number);
    const Light light = new_light(state);
    state.live.edits().will_change_light(name);
    state.session().scene().set_light(name, light);
    state.selection().light = name;
    state.selection().object.clear();
}

void scene_light(GuiState& state, const std::string& name) {
    const bool open = ImGui::TreeNodeEx(name.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
    note_place("Lights/" + name);
    if (!open) return;
    Light light = state.session().scene().light(name);
    if (light.type != LightType::directional) select_button(state, name);
    bool changed = false;
    if (begin_rows("light", false)) {
        begin_row("enabled");
        changed |= ImGui::Checkbox("##enabled", &light.enabled);
        note_place("Lights/enabled " + name);
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
    if (changed) {
        state.live.edits().will_change_light(name);
        state.session().scene().set_light(name, light);
    }
    const bool removed = ImGui::Button("Remove", ImVec2(-FLT_MIN, 0));
    note_place("Lights/remove " + name);
    if (removed) {
        state.live.edits().will_change_light(name);
        state.session().scene().remove_light(name);
        if (state.selection().light == name) state.selection().light.clear();
    }
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
    for (const std::string& name : state.session().scene().light_names()) scene_light(state, name);
    add_button(state);
}

}  // namespace easypbr::gui
