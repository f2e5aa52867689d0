// How a session's pictures get into memory: at once, or while others are drawn.
#include <utility>

#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/stopwatch.h"

namespace easypbr::app {

Image Session::render(const PictureOptions& options) {
    draw_frame(options);
    const gl::ContextScope scope(*context_);
    const Stopwatch watch(timing_.read);
    return read_annotated();
}

Image Session::read_annotated() {
    Image picture = warp(tiled_.empty() ? renderer_->read_picture() : tiled_, *lens_);
    draw_annotation(annotation_, annotation_settings_, picture);
    return picture;
}

Session::Pending Session::render_later(const PictureOptions& options, gl::Readback memory) {
    begin_frame(options);
    const gl::ContextScope scope(*context_);
    const Stopwatch watch(timing_.read);
    Pending pending{{}, std::move(memory), lens_, annotation_, annotation_settings_};
    pending.picture = tiled_.empty() ? renderer_->begin_reading(pending.pixels) : tiled_;
    return pending;
}

bool Session::is_read(const Pending& pending) {
    if (!pending.pixels.is_pending()) return true;
    const gl::ContextScope scope(context());
    return pending.pixels.is_done();
}

Image Session::finish(Pending& pending) {
    if (pending.pixels.is_pending()) {
        const gl::ContextScope scope(context());
        pending.pixels.finish(pending.picture.bytes());
    }
    Image picture =
        pending.lens->is_identity() ? std::move(pending.picture) : warp(pending.picture, *pending.lens);
    draw_annotation(pending.annotation, pending.annotation_settings, picture);
    return picture;
}

Image Session::drawn_picture() {
    const gl::ContextScope scope(*context_);
    return read_annotated();
}

Image Session::last_picture() {
    if (!renderer_) throw ArgumentError("nothing has been drawn yet");
    const gl::ContextScope scope(*context_);
    return read_annotated();
}

}  // namespace easypbr::app
