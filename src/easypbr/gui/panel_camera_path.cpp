#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "easypbr/core/error.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"
#include "easypbr/io/settings/camera_path_io.h"

namespace easypbr::gui {
namespace {

bool path_button(const char* name, float width, bool enabled = true) {
    return named_button("Camera path", name, width, enabled);
}

/// What a person asks of the keys; done after the table is drawn.
struct KeyWish {
    enum class What { none, look, replace, up, down, remove } what = What::none;
    size_t key = 0;
};

void do_wish(GuiState& state, const KeyWish& wish) {
    app::PathPlan& path = state.path();
    const size_t key = wish.key;
    switch (wish.what) {
        case KeyWish::What::none:
            return;
        case KeyWish::What::look:
            return path.look_from(key);
        case KeyWish::What::replace:
            return path.editor.replace(key, state.session().camera());
        case KeyWish::What::up:
            return path.move(key, key - 1);
        case KeyWish::What::down:
            return path.move(key, key + 1);
        case KeyWish::What::remove:
            return path.remove(key);
    }
}

void small_button(GuiState& state, KeyWish& wish, size_t key, const char* sign, const char* name,
                  const char* tooltip, KeyWish::What what, bool enabled = true) {
    ImGui::SameLine(0, 2 * state.screen.scale);
    ImGui::BeginDisabled(!enabled);
    if (ImGui::SmallButton(sign)) wish = {what, key};
    ImGui::EndDisabled();
    note_place(fmt::format("Camera path/{} {}", name, key + 1));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tooltip);
}

void key_row(GuiState& state, size_t key, double time, KeyWish& wish) {
    app::PathEditor& path = state.path().editor;
    const size_t count = path.keys().size();
    ImGui::PushID(int(key));
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    const bool chosen = state.path().key == key;
    const std::string label =
        time >= 0 ? fmt::format("{}   {:.2f} s", key + 1, time) : fmt::format("{}", key + 1);
    if (ImGui::Selectable(label.c_str(), chosen)) wish = {KeyWish::What::look, key};
    note_place(fmt::format("Camera path/key {}", key + 1));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Look from there");
    ImGui::TableNextColumn();
    if (key + 1 < count || path.options().closed) {
        float seconds = float(path.keys()[key].segment_s);
        ImGui::SetNextItemWidth(46 * state.screen.scale);
        if (ImGui::DragFloat("##segment", &seconds, 0.01f, 0.01f, 600, "%.2f", ImGuiSliderFlags_AlwaysClamp))
            path.set_segment(key, double(seconds));
        note_place(fmt::format("Camera path/seconds {}", key + 1));
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Seconds to the next key");
    }
    ImGui::TableNextColumn();
    ImGui::Dummy(ImVec2(0, 0));
    using What = KeyWish::What;
    small_button(state, wish, key, "=", "replace", "Make this key what is seen now", What::replace);
    small_button(state, wish, key, "\xe2\x86\x91", "up", "Earlier", What::up, key > 0);
    small_button(state, wish, key, "\xe2\x86\x93", "down", "Later", What::down, key + 1 < count);
    small_button(state, wish, key, "\xc3\x97", "remove", "Remove this key", What::remove);
    ImGui::PopID();
}

void key_table(GuiState& state) {
    const app::PathEditor& path = state.path().editor;
    const std::vector<double> times = path.path() ? path.path()->key_times_s() : std::vector<double>();
    KeyWish wish;
    const size_t count = path.keys().size();
    const float height =
        float(std::min<size_t>(count, 8)) * (ImGui::GetFrameHeight() + 4 * state.screen.scale) + 2;
    const ImGuiTableFlags flags = ImGuiTableFlags_NoSavedSettings | ImGuiTableFlags_ScrollY;
    if (!ImGui::BeginTable("keys", 3, flags, ImVec2(0, height))) return;
    ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("seconds", ImGuiTableColumnFlags_WidthFixed, 46 * state.screen.scale);
    ImGui::TableSetupColumn("buttons", ImGuiTableColumnFlags_WidthFixed, 100 * state.screen.scale);
    for (size_t key = 0; key < count; ++key) key_row(state, key, key < times.size() ? times[key] : -1, wish);
    ImGui::EndTable();
    do_wish(state, wish);
}

void shape_rows(GuiState& state) {
    app::PathEditor& path = state.path().editor;
    CameraPathOptions options = path.options();
    bool changed = false;
    const auto combo = [&](const char* name, int current, std::initializer_list<const char*> choices) {
        begin_row(name);
        ImGui::PushID(name);
        changed |= ImGui::Combo("##choice", &current, std::data(choices), int(choices.size()));
        note_place(std::string("Camera path/") + name);
        ImGui::PopID();
        return current;
    };
    if (!begin_rows("shape", false)) return;
    options.mode = PathMode(combo("curve", int(options.mode), {"smooth", "linear"}));
    options.ease = PathEase(combo("ease", int(options.ease), {"none", "in", "out", "in and out"}));
    begin_row("closed", "From the last key back to the first, and around");
    changed |= ImGui::Checkbox("##closed", &options.closed);
    note_place("Camera path/closed");
    begin_row("shown",
              "The curve and its cameras, over the picture; never in what is recorded without panels");
    ImGui::Checkbox("##shown", &state.path_panel.shows_path);
    end_rows();
    if (changed) path.set_options(options);
}

void play_rows(GuiState& state) {
    app::PathEditor& path = state.path().editor;
    const bool can_play = path.path().has_value();
    ImGui::BeginDisabled(!can_play);
    const float width = 60 * state.screen.scale;
    if (path_button(path.is_playing() ? "Pause" : "Play", width, can_play)) {
        if (path.is_playing())
            path.pause();
        else
            path.play();
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-FLT_MIN);
    float time = float(path.time());
    const float end = can_play ? float(path.path()->duration_s()) : 1;
    if (ImGui::SliderFloat("##time", &time, 0, end, "%.2f s", ImGuiSliderFlags_AlwaysClamp)) {
        path.pause();
        path.seek(double(time));
    }
    note_place("Camera path/time");
    ImGui::EndDisabled();
}

void file_rows(GuiState& state) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputText("##file", &state.path_panel.file);
    note_place("Camera path/file");
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (path_button("Save", half, state.path().editor.path().has_value())) {
        io::save_camera_path(*state.path().editor.path(), state.path_panel.file);
        state.notify("Saved " + state.path_panel.file);
    }
    ImGui::SameLine();
    if (path_button("Load", half)) {
        state.path().editor.set(io::load_camera_path(state.path_panel.file));
        state.path().key.reset();
    }
}

}  // namespace

void camera_path_panel(GuiState& state) try {
    const float third = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
    if (path_button("Add key (K)", third)) state.live.add_path_key();
    ImGui::SameLine();
    if (path_button("Turntable", third, !state.session().scene().names().empty())) state.live.set_turntable();
    ImGui::SameLine();
    if (path_button("Clear", third, !state.path().editor.keys().empty() || state.path().editor.path())) {
        state.path().editor.clear();
        state.path().key.reset();
    }
    if (!state.path().editor.keys().empty()) key_table(state);
    if (!state.path().editor.problem().empty()) {
        ImGui::PushTextWrapPos();
        ImGui::TextDisabled("%s", state.path().editor.problem().c_str());
        ImGui::PopTextWrapPos();
    }
    shape_rows(state);
    play_rows(state);
    file_rows(state);
} catch (const Error& error) {
    state.notify(error.what(), true);
}

}  // namespace easypbr::gui
