#include <imgui.h>

#include <algorithm>

#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"

namespace easypbr::gui {
namespace {

void which_row(app::AnimationPlayer& player) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool open = ImGui::BeginCombo("##which", player.names()[player.current()].c_str());
    note_place("Animations/which");
    if (!open) return;
    for (size_t i = 0; i < player.names().size(); ++i) {
        ImGui::PushID(int(i));
        if (ImGui::Selectable(player.names()[i].c_str(), i == player.current())) player.play(i);
        note_place("Animations/" + player.names()[i]);
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void time_row(GuiState& state, app::AnimationPlayer& player) {
    if (named_button("Animations", player.is_playing() ? "Pause" : "Play", 60 * state.screen.scale)) {
        if (player.is_playing())
            player.pause();
        else
            player.resume();
    }
    ImGui::SameLine();
    const double duration = player.duration_s();
    float time = float(std::clamp(player.shown_time(), 0.0, duration));
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::SliderFloat("##time", &time, 0, float(duration), "%.2f s", ImGuiSliderFlags_AlwaysClamp)) {
        player.pause();
        player.seek(double(time));
    }
    note_place("Animations/time");
}

}  // namespace

void animations_panel(GuiState& state) {
    app::AnimationPlayer& player = state.live.player();
    if (player.empty()) {
        dim_text("Nothing that is shown has any.");
        return;
    }
    which_row(player);
    time_row(state, player);
    if (!begin_rows("how", false)) return;
    begin_row("speed", "1: as it was made; below 0: backwards");
    float speed = float(player.speed());
    if (ImGui::SliderFloat("##speed", &speed, -2, 4, "%.2f", ImGuiSliderFlags_AlwaysClamp))
        player.set_speed(double(speed));
    note_place("Animations/speed");
    begin_row("loop");
    bool loop = player.loops();
    if (ImGui::Checkbox("##loop", &loop)) player.set_loop(loop);
    note_place("Animations/loop");
    end_rows();
}

}  // namespace easypbr::gui
