// What a view does by itself, frame by frame: camera paths and recordings.
#include <fmt/format.h>

#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/gui/live_view.h"

namespace easypbr::gui {
namespace {

using Moved = std::vector<std::pair<Mesh, Eigen::Affine3d>>;

/// Where a node was, "car/wheel" and T_world_mesh, before it and what it hangs from moved.
Eigen::Affine3d pose_before(const Scene& scene, const std::string& name, const Eigen::Affine3d& T_world_mesh,
                            const Moved& moved) {
    Eigen::Affine3d now = Eigen::Affine3d::Identity(), before = now;
    for (size_t at = 0; at != name.npos;) {
        at = name.find('/', at + 1);
        const std::optional<Mesh> node = node_named(scene, name.substr(0, at));
        if (!node) continue;
        const Eigen::Affine3d own = node->T_parent_mesh();
        const auto motion = std::ranges::find(moved, *node, &Moved::value_type::first);
        now = now * own;
        before = before * own * (motion == moved.end() ? Eigen::Affine3d::Identity() : motion->second);
    }
    if (before.matrix() == now.matrix()) return T_world_mesh;
    // By what it moved in the world, so that the scene's origin does not matter.
    return before * now.inverse(Eigen::Affine) * T_world_mesh;
}

}  // namespace

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

app::Session::RefinedMotion LiveView::shown_motion() {
    if (!state_.resolved || !(state_.form.fps > 0)) return nullptr;
    const double frame_s = 1 / state_.form.fps;
    Motion motion(session_.scene().snapshot(), state_.resolved->camera);
    const auto moved = state_.player->motion(frame_s);
    for (auto& [name, pose] : motion.poses) pose = pose_before(session_.scene(), name, pose, moved);
    const auto& path = state_.path.path();
    const Eigen::Isometry3d& now = state_.resolved->camera.T_world_cam;
    if (const auto before = recording_.camera_before())
        motion.camera = *before;
    else if (path && now.isApprox(path->pose(state_.path.time()), 1e-9))
        motion.camera = path->camera(state_.path.time() - frame_s, state_.resolved->camera);
    return std::make_shared<const Motion>(std::move(motion));
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
        if (!recording_.frame().empty()) {
            show_pixels(with_channels(to_u8(recording_.frame()), 4));
            state_.shows_recording = true;
        }
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
