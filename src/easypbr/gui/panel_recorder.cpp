#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <cmath>

#include "easypbr/app/live_recording.h"
#include "easypbr/gui/panels.h"
#include "easypbr/gui/widgets.h"

namespace easypbr::gui {
namespace {

void text_row(const char* name, std::string& text, const char* tooltip) {
    begin_row(name, tooltip);
    ImGui::PushID(name);
    ImGui::InputText("##text", &text);
    note_place(std::string("Recorder/") + name);
    ImGui::PopID();
}

void form_rows(GuiState& state) {
    app::RecordingForm& form = state.live.recording_form();
    if (!begin_rows("form", false)) return;
    text_row("picture", form.picture, "PNG, JPEG, HDR or EXR");
    text_row("video", form.video,
             "MP4, MOV, MKV, WebM or GIF; or a picture for each frame: out/frame_%04d.png");
    begin_row("size", "Width and height; 0: the settings' picture size (image.size)");
    ImGui::BeginDisabled(form.panels);
    Vec2i size = form.panels ? state.screen.size : form.size;
    if (ImGui::InputInt2("##size", size.data())) form.size = size.cwiseMax(0).cwiseMin(max_image_side);
    ImGui::EndDisabled();
    note_place("Recorder/size");
    begin_row("frames per second");
    float fps = float(form.fps);
    if (ImGui::DragFloat("##fps", &fps, 0.5f, 1, 240, "%.4g", ImGuiSliderFlags_AlwaysClamp))
        form.fps = double(fps);
    begin_row("transparent", "Nothing in place of the background: PNG and EXR");
    ImGui::BeginDisabled(form.panels);
    ImGui::Checkbox("##transparent", &form.transparent);
    ImGui::EndDisabled();
    note_place("Recorder/transparent");
    begin_row("with panels", "The window as it is, in its own size");
    ImGui::Checkbox("##panels", &form.panels);
    note_place("Recorder/with panels");
    end_rows();
}

std::string time_text(double seconds) {
    const long whole = std::lround(seconds);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

void progress_rows(GuiState& state) {
    const app::LiveRecording& recording = state.live.recording();
    if (recording.is_path()) {
        const std::string text = fmt::format("{} of {}, {} left", recording.frames(), recording.total(),
                                             time_text(recording.seconds_left()));
        ImGui::ProgressBar(float(recording.frames()) / float(recording.total()), ImVec2(-FLT_MIN, 0),
                           text.c_str());
    } else {
        ImGui::TextUnformatted(fmt::format("{} frames, {}", recording.frames(),
                                           time_text(recording.frames() / state.live.recording_form().fps))
                                   .c_str());
    }
    if (named_button("Recorder", "Stop", -FLT_MIN))
        state.live.wishes().recording = app::LiveWishes::Recording::stop;
}

}  // namespace

void recorder_panel(GuiState& state) {
    const bool running = state.live.recording().is_running();
    ImGui::BeginDisabled(running);
    form_rows(state);
    ImGui::EndDisabled();
    if (running) {
        progress_rows(state);
    } else {
        const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
        if (named_button("Recorder", "Picture", half))
            state.live.wishes().recording = app::LiveWishes::Recording::picture;
        ImGui::SameLine();
        if (named_button("Recorder", "Video", half))
            state.live.wishes().recording = app::LiveWishes::Recording::video;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Records what happens from now on, in real time");
        if (named_button("Recorder", "Camera path", -FLT_MIN, state.path().editor.path().has_value()))
            state.live.wishes().recording = app::LiveWishes::Recording::path;
    }
    if (state.live.report().text.empty()) return;
    const ImVec4 red(0.93f, 0.36f, 0.33f, 1);
    ImGui::PushStyleColor(ImGuiCol_Text,
                          state.live.report().failed ? red : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(state.live.report().text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

}  // namespace easypbr::gui
