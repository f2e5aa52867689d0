#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "easypbr/core/color.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"
#include "easypbr/scene/light_table.h"
#include "easypbr/scene/resolve.h"

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

/// A row of one of the light's fields. Returns whether the person has changed it.
bool light_row(GuiState& state, const std::string& name, const LightField& field, Light& light) {
    FieldInfo info = field;
    Value value = field.get(light);
    if (field.is_color) {
        // A person chooses colours as they are shown.
        info.type = FieldType::color;
        const Vec3 srgb = srgb_from_linear(light.color);
        value.data = std::vector<double>{srgb[0], srgb[1], srgb[2]};
    }
    std::optional<Value> inferred;
    const ResolvedSettings* resolved = state.live.picture().resolved();
    if (field.can_be_automatic && resolved && resolved->light_radii.contains(name))
        inferred = Value{double(resolved->light_radii.at(name))};
    const Light before = light;
    field_row(info, value, inferred, [&](Value chosen) {
        if (field.is_color) {
            const auto& srgb = std::get<std::vector<double>>(chosen.data);
            const Vec3 linear = linear_from_srgb(Vec3(float(srgb[0]), float(srgb[1]), float(srgb[2])));
            chosen.data = std::vector<double>{linear[0], linear[1], linear[2]};
        }
        field.put(light, chosen);
    });
    note_place("Lights/" + field.name + " " + name);
    // A direction on its way through zero would be none.
    if (!(light.direction.norm() > 1e-6f)) light.direction = before.direction;
    return !(light == before);
}

void scene_light(GuiState& state, const std::string& name) {
    const bool open = ImGui::TreeNodeEx(name.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
    note_place("Lights/" + name);
    if (!open) return;
    Light light = state.session().scene().light(name);
    if (light.type != LightType::directional) select_button(state, name);
    bool changed = false;
    if (begin_rows("light", false)) {
        for (const LightField& field : light_fields())
            if (field.concerns(light.type)) changed |= light_row(state, name, field, light);
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
