// What a live drawing does by itself, frame by frame: camera paths and recordings.
#include <fmt/format.h>

#include <utility>

#include "easypbr/app/live_drawing.h"
#include "easypbr/app/recording_target.h"
#include "easypbr/core/error.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::app {
void PathPlan::look_from(size_t chosen) {
    key = chosen;
    editor.pause();
    if (editor.path() && chosen < editor.path()->key_times_s().size())
        editor.seek(editor.path()->key_times_s()[chosen]);
    else
        look_at_key = chosen;
}

void PathPlan::move(size_t from, size_t to) {
    editor.move(from, to);
    if (!key) return;
    if (*key == from)
        key = to;
    else if (from < *key && *key <= to)
        --*key;
    else if (to <= *key && *key < from)
        ++*key;
}

void PathPlan::remove(size_t removed) {
    editor.remove(removed);
    if (key == removed)
        key.reset();
    else if (key && *key > removed)
        --*key;
}

void LiveDrawing::move_along_path(double seconds) {
    const bool moves = path_.editor.advance(seconds);
    const auto key = std::exchange(path_.look_at_key, {});
    if (recording_.is_path() || (!moves && !key) || session_.scene().names().empty()) return;
    ViewPoint view = session_.view_point(size_);
    const double distance = view.distance();
    if (key && *key < path_.editor.keys().size())
        view.camera.T_world_cam = path_.editor.keys()[*key].T_world_cam;
    else if (path_.editor.path())
        view.camera = path_.editor.path()->camera(path_.editor.time(), view.camera);
    view.target = view.camera.position() - distance * view.camera.T_world_cam.linear().col(2);
    session_.set_view_point(view);
}

Session::RefinedMotion LiveDrawing::shown_motion(const Camera& now) const {
    if (!(form_.fps > 0)) return nullptr;
    const double frame_s = 1 / form_.fps;
    const SceneSnapshot scene = session_.scene().snapshot();
    Motion motion(scene, now);
    motion.replace(scene, player_.motion(frame_s));
    const auto& path = path_.editor.path();
    if (const auto before = recording_.camera_before())
        motion.camera = *before;
    else if (path && now.T_world_cam.isApprox(path->pose(path_.editor.time()), 1e-9))
        motion.camera = path->camera(path_.editor.time() - frame_s, now);
    return std::make_shared<const Motion>(std::move(motion));
}

void LiveDrawing::tell(const std::string& text, bool failed) {
    report_ = {text, failed};
    notifications_.add(text, failed);
}

void LiveDrawing::begin_recording(LiveWishes::Recording wish, const LiveScreens& screens) {
    using Wish = LiveWishes::Recording;
    RecordingForm form = form_;
    form.panels &= bool(screens.shown);
    if (wish == Wish::none || wish == Wish::stop) return;
    // What a person made before stays.
    if (wish == Wish::picture) {
        form.picture = free_picture(form.picture).string();
        return tell("Wrote " + recording_.picture(form, screens.finished), false);
    }
    form.video = free_recording(form.video).string();
    if (wish == Wish::video) recording_.start(form, size_);
    if (wish == Wish::path && path_.editor.path()) {
        path_.editor.pause();
        recording_.start_path(form, size_, *path_.editor.path());
    }
}

void LiveDrawing::record(const LiveScreens& screens) {
    const LiveWishes::Recording wish = std::exchange(wishes_.recording, LiveWishes::Recording::none);
    try {
        begin_recording(wish, screens);
        if (wish == LiveWishes::Recording::stop) return stop_recording();
        if (!recording_.is_running()) return;
        recording_.advance(screens.finished, screens.shown);
        if (!recording_.frame().empty()) picture_.show(with_channels(picture_to_u8(recording_.frame()), 4));
        if (recording_.is_path() && recording_.frames() == recording_.total()) stop_recording();
    } catch (const std::exception& error) {
        tell(error.what(), true);
    }
}

void LiveDrawing::stop_recording() {
    if (!recording_.is_running()) return;
    const std::string video = recording_.file();
    try {
        tell(fmt::format("Wrote {}: {} frames", video, recording_.stop()), false);
    } catch (const std::exception& error) {
        tell(error.what(), true);
    }
}

}  // namespace easypbr::app
