// The tools of what moves: the camera's path, recordings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/remote/tool_panels.h"

namespace easypbr::remote {
namespace {

using Recording = app::LiveWishes::Recording;

// ---- path

/// Of the chosen key.
void key_rows(RecordedWidgets& ui, app::LiveDrawing& live, size_t key) {
    app::PathEditor& path = live.path().editor;
    const size_t count = path.keys().size();
    if (key + 1 < count || path.options().closed) {
        double seconds = path.keys()[key].segment_s;
        if (ui.slider("seconds to the next key", seconds, 0.05, 60)) path.set_segment(key, seconds);
    }
    const bool replaces = ui.button("Replace");
    ui.same_line();
    const bool rises = ui.button("Earlier");
    ui.same_line();
    const bool falls = ui.button("Later");
    ui.same_line();
    const bool goes = ui.button("Remove");
    if (replaces) path.replace(key, live.session().camera());
    if (rises && key > 0) live.path().move(key, key - 1);
    if (falls && key + 1 < count) live.path().move(key, key + 1);
    if (goes) live.path().remove(key);
}

void key_list(RecordedWidgets& ui, app::LiveDrawing& live) {
    const app::PathEditor& path = live.path().editor;
    const std::vector<double> times = path.path() ? path.path()->key_times_s() : std::vector<double>();
    for (size_t key = 0; key < path.keys().size(); ++key) {
        std::string label = fmt::format("Key {}", key + 1);
        if (key < times.size()) label += fmt::format(", at {:.2f} s", times[key]);
        if (ui.button(label)) live.path().look_from(key);
        if (live.path().key == key) key_rows(ui, live, key);
    }
}

template <class Choice>
bool choice_row(RecordedWidgets& ui, const std::string& name, Choice& choice,
                const std::vector<std::string>& names) {
    std::string chosen = names[size_t(choice)];
    if (!ui.combo(name, chosen, names)) return false;
    choice = Choice(std::ranges::find(names, chosen) - names.begin());
    return true;
}

void shape_rows(RecordedWidgets& ui, app::PathEditor& path) {
    CameraPathOptions options = path.options();
    bool changed = choice_row(ui, "curve", options.mode, {"smooth", "linear"});
    changed |= choice_row(ui, "ease", options.ease, {"none", "in", "out", "in and out"});
    changed |= ui.checkbox("closed", options.closed);
    if (changed) path.set_options(options);
}

void play_rows(RecordedWidgets& ui, app::PathEditor& path) {
    if (ui.button(path.is_playing() ? "Pause" : "Play")) path.is_playing() ? path.pause() : path.play();
    double time = std::round(path.time() * 100) / 100;
    if (!ui.slider("time", time, 0, path.path()->duration_s())) return;
    path.pause();
    path.seek(time);
}

// ---- recording

void form_rows(RecordedWidgets& ui, VideoForm& form) {
    using Limits = VideoDownloads;
    ui.combo("format", form.format, VideoDownloads::formats());
    ui.slider("width", form.size.x(), Limits::least_side, Limits::most_side);
    ui.slider("height", form.size.y(), Limits::least_side, Limits::most_side);
    ui.slider("frames per second", form.fps, 1, Limits::most_fps);
}

void progress_rows(RecordedWidgets& ui, const app::LiveRecording& recording, int fps) {
    if (!recording.is_path())
        return ui.text(
            fmt::format("{} frames, {:.0f} s", recording.frames(), recording.frames() / double(fps)));
    const int total = std::max(recording.total(), 1);
    ui.progress(double(recording.frames()) / total,
                fmt::format("{} of {}, {:.0f} s left", recording.frames(), total, recording.seconds_left()));
}

void require_frames(const CameraPath& path, int fps) {
    if (path.duration_s() * fps > VideoDownloads::most_frames)
        throw ArgumentError(fmt::format("a recording has at most {} frames", VideoDownloads::most_frames));
}

}  // namespace

void path_tool(RecordedWidgets& ui, ToolState& state) {
    app::LiveDrawing& live = state.live;
    app::PathEditor& path = live.path().editor;
    if (live.session().scene().names().empty()) return ui.text("Nothing is shown yet.");
    if (ui.button("Add key")) live.add_path_key();
    ui.same_line();
    if (ui.button("Turntable")) live.set_turntable();
    ui.same_line();
    if (ui.button("Clear")) path.clear(), live.path().key.reset();
    key_list(ui, live);
    if (!path.problem().empty()) ui.text(path.problem());
    if (path.path()) play_rows(ui, path);
    if (ui.section("Shape", false)) shape_rows(ui, path);
}

void recording_tool(RecordedWidgets& ui, ToolState& state) {
    app::LiveDrawing& live = state.live;
    VideoDownloads& videos = state.videos;
    if (live.recording().is_running()) {
        progress_rows(ui, live.recording(), videos.form.fps);
        if (ui.button("Stop")) videos.stop();
        return;
    }
    form_rows(ui, videos.form);
    if (ui.button("Record what happens")) videos.begin(Recording::video);
    const auto& path = live.path().editor.path();
    if (path) ui.same_line();
    if (path && ui.button("Record the camera path")) {
        require_frames(*path, videos.form.fps);
        videos.begin(Recording::path);
    }
    if (!live.report().text.empty()) ui.text(videos.plain(live.report().text));
    if (videos.can_fetch() && ui.button("Download again")) state.wants_video = true;
}

}  // namespace easypbr::remote
