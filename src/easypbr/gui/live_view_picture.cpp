// What a view shows: a quick picture while something moves, refined when it rests, and the panels over it.
#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>

#include "easypbr/app/channels.h"
#include "easypbr/core/error.h"
#include "easypbr/gl/context.h"
#include "easypbr/gui/live_view.h"

namespace easypbr::gui {
namespace {

/// A picture of fewer frames is worse than a single one, whose edges are smoothed.
constexpr int least_frames = 4;
/// What a frame may take while something moves, and the resolutions that it may have for that.
constexpr double slow_seconds = 0.07, quick_seconds = 0.03;
constexpr double lowest_reduction = 0.25;
/// Pictures after which a screenshot waits no longer for one that stays.
constexpr uint64_t most_changes = 8;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Vec2i reduced(Vec2i size, double factor) {
    return {std::max(1, int(size.x() * factor)), std::max(1, int(size.y() * factor))};
}

bool make_texture(gl::Texture& texture, Vec2i size) {
    if (texture && texture.width() == size.x() && texture.height() == size.y()) return false;
    texture = gl::Texture(gl::Format::rgba8, size.x(), size.y());
    texture.sampling(gl::Filtering::linear);
    return true;
}

}  // namespace

bool LiveView::draw_picture() {
    uint64_t drawing = 0;  // No version: nothing had been begun when it failed.
    try {
        const uint64_t version = session_.picture_version(state_.size);
        const bool moving = is_moving();
        const bool software = session_.context_info().software;
        const Vec2i wanted = moving && software ? reduced(state_.size, reduction_) : state_.size;
        const std::pair motion_key(state_.player->speed(), state_.form.fps);
        const bool other_motion = session_.settings().motion_blur.enabled && motion_key != motion_key_;
        const bool stale = version != version_ || state_.shows_recording ||
                           shown_channel_ != state_.channel || failed_ || other_motion ||
                           (!moving && quick_size_ != state_.size);
        bool drew = false;
        // What failed fails again until something changes.
        if (failed_ && version == failed_version_ && shown_channel_ == state_.channel &&
            failed_size_ == state_.size)
            return false;
        drawing = version;
        if (stale) {
            version_ = version;
            motion_key_ = motion_key;
            shown_channel_ = state_.channel;
            quick_size_ = wanted;
            failed_ = false;
            drew = draw_quickly(moving && software);
        } else if (frames_ < state_.statistics.total && !moving) {
            drew = refine();
        } else if (wants_hover_ && !moving) {
            wants_hover_ = false;
            state_.hovered = surfaces().at(pointer_);
            drew = true;
        }
        last_error_.clear();
        return drew;
    } catch (const Error& error) {
        // Told once; drawn again when something changes.
        if (last_error_ != error.what() && !session_.scene().names().empty())
            state_.notify(error.what(), true);
        const bool is_new = last_error_ != error.what();
        last_error_ = error.what();
        failed_ = true;
        failed_version_ = drawing;
        failed_size_ = state_.size;
        // The last picture that there was stays, as long as there is something to show.
        if (is_new && session_.scene().names().empty()) shown_ = gl::Texture();
        return is_new;
    }
}

bool LiveView::draw_quickly(bool adapt) {
    const double start = now();
    const bool layer = shows_layers() && state_.channel != "slices";
    const bool measures = state_.show_panels && state_.is_open(Panel::statistics) && !layer;
    session_.renderer().measure_passes(measures);
    if (!layer) session_.refine({quick_size_, 1});
    state_.statistics.passes =
        measures ? session_.renderer().pass_times() : decltype(state_.statistics.passes){};
    session_.renderer().measure_passes(false);
    show_picture();
    glFinish();
    const double seconds = now() - start;
    if (adapt && seconds > slow_seconds) reduction_ = std::max(lowest_reduction, reduction_ * 0.75);
    if (adapt && seconds < quick_seconds) reduction_ = std::min(1.0, reduction_ * 1.2);
    state_.statistics.frame_seconds = seconds;
    state_.statistics.size = quick_size_;
    ++state_.statistics.pictures;
    frames_ = 0;
    state_.statistics.total = layer ? 0 : session_.settings().image.samples;
    state_.statistics.frames = layer ? 0 : 1;
    if (state_.statistics.total == 1) frames_ = 1;
    state_.resolved = session_.resolve(state_.size);
    motion_ = session_.settings().motion_blur.enabled ? shown_motion() : nullptr;
    state_.hovered.reset();
    wants_hover_ |= pointer_.x() >= 0 || shows_path();
    return true;
}

bool LiveView::refine() {
    const double start = now();
    const int total = state_.statistics.total;
    const bool show = frames_ + 1 >= std::min(least_frames, total);
    const app::Session::Refinement done = session_.refine({state_.size, total}, show, motion_);
    frames_ = state_.statistics.frames = done.frames;
    if (show && (state_.channel == "picture" || frames_ == total)) show_picture();
    glFinish();
    state_.statistics.frame_seconds = now() - start;
    return show;
}

void LiveView::show_picture() {
    state_.shows_recording = false;
    const AnnotationSettings& annotation = session_.settings().annotation;
    if (state_.channel == "slices") {
        std::vector<Image> pictures = {session_.last_picture()};
        const std::vector<std::string> names = {"metallic", "albedo", "ambient_occlusion", "normal_world"};
        const auto layers = session_.render_layers(names, quick_size_);
        for (const std::string& name : names) pictures.push_back(app::layer_picture(name, layers.at(name)));
        show_pixels(app::slices(pictures));
    } else if (shows_layers()) {
        show_pixels(app::layer_picture(
            state_.channel, session_.render_layers({state_.channel}, quick_size_).at(state_.channel)));
    } else if (annotation.legend.value_or(false) || annotation.colorbar.value_or(false) ||
               !session_.lens().is_identity()) {
        show_pixels(session_.last_picture());
    } else {
        const gl::Texture& picture = session_.renderer().picture();
        make_texture(shown_, {picture.width(), picture.height()});
        gl::copy(picture, shown_);
    }
}

void LiveView::show_pixels(const Image& image) {
    make_texture(shown_, {image.width(), image.height()});
    shown_.upload(image.bytes());
}

bool LiveView::draw_screen(double seconds, bool always) {
    const bool is_new = make_texture(screen_, state_.size);
    if (is_new) screen_framebuffer_ = gl::Framebuffer({&screen_});
    since_panels_ = 0;
    state_.surfaces = surfaces_ && surfaces_version_ == version_ ? &*surfaces_ : nullptr;
    const bool changed = gui_.lay_out(state_, seconds, shown_, [&] {
        if (!state_.show_panels) return;
        images_.draw(state_);
        panels_.draw(state_);
    });
    if (!always && !changed && !is_new) return false;
    const float grey[4] = {0.25f, 0.25f, 0.25f, 1};
    screen_framebuffer_.clear_color(0, grey);
    gui_.paint(screen_framebuffer_);
    return true;
}

Image LiveView::screen() {
    if (!screen_) throw ArgumentError("nothing has been drawn yet");
    const gl::ContextScope scope(session_.context());
    Image image(screen_.width(), screen_.height(), 4, PixelType::u8);
    screen_framebuffer_.read(0, gl::Format::rgba8, 0, 0, image.width(), image.height(), image.bytes());
    return image;
}

Image LiveView::finished_screen(Vec2i size, float scale) {
    touch();
    const uint64_t begun = state_.statistics.pictures;
    do update({}, size, scale, 1.0 / 60);
    while (busy_ && state_.statistics.pictures < begun + most_changes);
    return screen();
}

}  // namespace easypbr::gui
