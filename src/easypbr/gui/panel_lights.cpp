#include <imgui.h>

#include "easypbr/app/light_edits.h"
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

void add_button(GuiState& state) {
    if (named_button("Lights", "Add a light", -FLT_MIN)) app::add_light(state.live);
}

/// A row of one of the light's fields.
void light_row(GuiState& state, const std::string& name, const LightField& field, Light& light) {
    field_row(app::shown_field(field), app::shown_value(field, light),
              app::inferred_value(state.live, name, field),
              [&](const Value& chosen) { app::put_shown(field, light, chosen); });
    note_place("Lights/" + field.name + " " + name);
}

void scene_light(GuiState& state, const std::string& name) {
    const bool open = ImGui::TreeNodeEx(name.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
    note_place("Lights/" + name);
    if (!open) return;
    Light light = state.session().scene().light(name);
    if (light.type != LightType::directional) select_button(state, name);
    const Light before = light;
    if (begin_rows("light", false)) {
        for (const LightField& field : light_fields())
            if (field.concerns(light.type)) light_row(state, name, field, light);
        end_rows();
    }
    if (!(light == before)) app::change_light(state.live, name, light);
    const bool removed = ImGui::Button("Remove", ImVec2(-FLT_MIN, 0));
    note_place("Lights/remove " + name);
    if (removed) app::remove_light(state.live, name);
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
