// What a view does by itself, frame by frame: camera paths and recordings.
#include <fmt/format.h>

#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/gui/live_view.h"

namespace easypbr::gui {

void LiveView::show_image(const std::string& name, Image image, const ImageLook& look) {
    images_.show(name, std::move(image), look);
    touch();
}

void LiveView::remove_image(const std::string& name) {
    images_.remove(name);
    touch();
}

void LiveView::move_along_path(double seconds) {
    const bool moves = state_.path.advance(seconds);
    const auto key = std::exchange(state_.look_at_key, {});
    if (recording_.is_path() || (!moves && !key) || session_.scene().names().empty()) return;
    app::ViewPoint view = session_.view_point(state_.size);
    const double distance = view.distance();
    if (key && *key < state_.path.keys().size())
        view.camera.T_world_cam = state_.path.keys()[*key].T_world_cam;
    else if (state_.path.path())
        view.camera = state_.path.path()->camera(state_.path.time(), view.camera);
    view.target = view.camera.position() - distance * view.camera.T_world_cam.linear().col(2);
    session_.set_view_point(view);
}

void LiveView::say(const std::string& text, bool failed) {
    state_.recorder_says = text;
    state_.recorder_failed = failed;
    state_.notify(text, failed);
    touch();
}

void LiveView::record() {
    const auto finished = [this] { return finished_now(); };
    const auto shown = [this] { return screen(); };
    const RecorderWish wish = std::exchange(state_.wish, RecorderWish::none);
    const std::string video = state_.form.video;
    try {
        if (wish == RecorderWish::picture) say("Wrote " + recording_.picture(state_.form, finished), false);
        if (wish == RecorderWish::video) recording_.start(state_.form, state_.size);
        if (wish == RecorderWish::path && state_.path.path()) {
            state_.path.pause();
            recording_.start_path(state_.form, state_.size, *state_.path.path());
        }
        if (wish == RecorderWish::stop) return stop_recording();
        if (!recording_.is_running()) return;
        recording_.advance(finished, shown);
        gui_frames_ = std::max(gui_frames_, 1);
        if (!recording_.frame().empty()) show_pixels(with_channels(to_u8(recording_.frame()), 4));
        if (recording_.is_path() && recording_.frames() == recording_.total()) stop_recording();
    } catch (const std::exception& error) {
        say(error.what(), true);
    }
}

void LiveView::stop_recording() {
    if (!recording_.is_running()) return;
    const std::string video = state_.form.video;
    try {
        say(fmt::format("Wrote {}: {} frames", video, recording_.stop()), false);
    } catch (const std::exception& error) {
        say(error.what(), true);
    }
}

Image LiveView::finished_now() {
    do draw_picture();
    while (!failed_ && frames_ < state_.statistics.total);
    if (shows_path()) surfaces();
    draw_screen(0, true);
    return screen();
}

}  // namespace easypbr::gui
