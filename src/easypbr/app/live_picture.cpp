#include "easypbr/app/live_picture.h"

#include <algorithm>

#include "easypbr/app/channels.h"
#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/core/stopwatch.h"
#include "easypbr/gl/context.h"
#include "easypbr/gl/draw.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

/// A picture of fewer frames is worse than a single one, whose edges are smoothed.
constexpr int least_frames = 4;
/// Frames that take less than this share of what they may can be larger; the least resolution.
constexpr double quick_share = 0.43;
constexpr double lowest_reduction = 0.25;

Vec2i reduced(Vec2i size, double factor) {
    return {std::max(1, int(size.x() * factor)), std::max(1, int(size.y() * factor))};
}

void fit_texture(gl::Texture& texture, Vec2i size) {
    if (texture && texture.width() == size.x() && texture.height() == size.y()) return;
    texture = gl::Texture(gl::Format::rgba8, size.x(), size.y());
    texture.sampling(gl::Filtering::linear);
}

}  // namespace

bool LivePicture::is_stale(const LiveShot& shot, uint64_t version) const {
    const bool other_motion = session_.settings().motion_blur.enabled && shot.motion_key != shown_.motion;
    return version != shown_.version || shows_other_ || shown_.channel != shot.channel || has_failed() ||
           other_motion || (!shot.moving && shown_.size != shot.size);
}

bool LivePicture::draw(const LiveShot& shot) {
    const gl::ContextScope scope(session_.context());
    if (device_ != session_.device_number()) forget_device();
    uint64_t version = 0;
    try {
        gl::Context::check();
        version = session_.picture_version(shot.size);
        // What failed fails again until something changes.
        if (has_failed() && version == failure_->version && shot.channel == failure_->channel &&
            shot.size == failure_->size)
            return false;
        const bool drew = step(shot, version);
        last_error_.clear();
        return drew;
    } catch (const gl::ContextLost&) {
        forget_device();
        return false;
    } catch (const Error& error) {
        return fail(error.what(), shot, version);
    }
}

void LivePicture::forget_device() {
    device_ = session_.device_number();
    forget_image();
    shown_ = {};
    failure_.reset();
    frames_ = 0;
    statistics_.total = std::max(1, statistics_.total);
}

bool LivePicture::step(const LiveShot& shot, uint64_t version) {
    if (is_stale(shot, version)) {
        const bool reduces = shot.moving && session_.context_info().software;
        const double share = std::min(reduces ? reduction_ : 1.0, shot.moving ? shot.resolution : 1.0);
        shown_ = {version, shot.channel, share < 1 ? reduced(shot.size, share) : shot.size, shot.motion_key};
        failure_.reset();
        draw_quickly(shot, reduces);
        return true;
    }
    if (shot.moving || !shot.refines) return false;
    if (!is_complete()) return refine(shot);
    if (!std::exchange(wants_surfaces_, false)) return false;
    hovered_ = surfaces(shot.size).at(pointer_);
    return true;
}

bool LivePicture::fail(const std::string& what, const LiveShot& shot, uint64_t version) {
    const bool is_new = std::exchange(last_error_, what) != what;
    failure_ = {version, shot.channel, shot.size, {}};
    // The last picture that there was stays, as long as there is something to show.
    if (is_new && session_.scene().names().empty()) forget_image();
    return is_new;
}

void LivePicture::finish(LiveShot shot) {
    shot.moving = false;
    shot.interrupt = nullptr;  // Input is taken afterwards: a picture begun anew would never end.
    do draw(shot);
    while (!has_failed() && !is_complete() && !session_.is_stuck());
}

void LivePicture::draw_quickly(const LiveShot& shot, bool adapt) {
    double seconds = 0;
    const bool layer = is_layer(shot.channel);
    const bool measures = shot.pass_times && !layer;
    {
        const Stopwatch watch(seconds);
        render::Renderer& renderer = session_.renderer();
        renderer.measure_passes(measures);
        const Drawn drawn = layer ? Drawn() : session_.refine({shown_.size, 1}).drawn;
        statistics_.passes = measures ? renderer.pass_times() : decltype(statistics_.passes){};
        renderer.measure_passes(false);
        show_picture(drawn);
        gl::finish();
    }
    if (adapt && seconds > shot.longest_s) reduction_ = std::max(lowest_reduction, reduction_ * 0.75);
    if (adapt && seconds < quick_share * shot.longest_s) reduction_ = std::min(1.0, reduction_ * 1.2);
    statistics_.frame_seconds = seconds;
    statistics_.size = shown_.size;
    ++statistics_.pictures;
    statistics_.total = layer ? 0 : session_.settings().image.samples;
    statistics_.frames = layer ? 0 : 1;
    frames_ = statistics_.total == 1 ? 1 : 0;
    resolved_ = std::make_shared<const ResolvedSettings>(session_.resolve(shot.size));
    const bool blurs = session_.settings().motion_blur.enabled && shot.motion;
    motion_ = blurs ? shot.motion(resolved_->camera) : nullptr;
    hovered_.reset();
    wants_surfaces_ |= pointer_.x() >= 0 || shot.surfaces;
}

bool LivePicture::refine(const LiveShot& shot) {
    statistics_.frame_seconds = 0;
    const Stopwatch watch(statistics_.frame_seconds);
    const int total = statistics_.total;
    const bool show = frames_ + 1 >= std::min(least_frames, total);
    Session::Refinement done;
    try {
        const InterruptScope scope(shot.interrupt, true);
        done = session_.refine({shot.size, total}, show, motion_);
    } catch (const Interrupted&) {
        check_interrupt();  // Who waits outside is told.
        frames_ = 0;
        return false;
    }
    frames_ = statistics_.frames = done.frames;
    statistics_.total = done.total;
    if ((show || is_complete()) && (shot.channel == "picture" || is_complete())) show_picture(done.drawn);
    gl::finish();
    return show;
}

void LivePicture::show_picture(const Drawn& drawn) {
    shows_other_ = false;
    if (shown_.channel == "slices") {
        std::vector<Image> pictures = {drawn.picture()};
        const std::vector<std::string> names = {"metallic", "albedo", "ambient_occlusion", "normal_world"};
        const auto layers = session_.render_layers(names, shown_.size);
        for (const std::string& name : names) pictures.push_back(layer_picture(name, layers.at(name)));
        show_pixels(slices(pictures));
    } else if (is_layer(shown_.channel)) {
        const auto layers = session_.render_layers({shown_.channel}, shown_.size);
        show_pixels(layer_picture(shown_.channel, layers.at(shown_.channel)));
    } else if (!drawn.is_plain() || drawn.is_in_memory()) {
        show_pixels(drawn.picture());
    } else {
        const gl::Texture& picture = drawn.texture();
        fit_texture(texture_, {picture.width(), picture.height()});
        gl::copy(picture, texture_);
        pixels_ = Image();
    }
}

void LivePicture::show_pixels(Image image) {
    pixels_ = std::move(image);
    is_uploaded_ = false;
}

void LivePicture::forget_image() {
    pixels_ = Image();
    texture_ = gl::Texture();
}

const gl::Texture& LivePicture::texture() const {
    if (!pixels_.empty() && !std::exchange(is_uploaded_, true)) {
        fit_texture(texture_, {pixels_.width(), pixels_.height()});
        texture_.upload(pixels_.bytes());
    }
    return texture_;
}

void LivePicture::show(const Image& image) {
    const gl::ContextScope scope(session_.context());
    if (device_ != session_.device_number()) forget_device();
    show_pixels(image);
    shows_other_ = true;
}

Image LivePicture::image() const {
    if (!has_image()) throw ArgumentError("nothing has been drawn yet");
    if (!pixels_.empty()) return pixels_;
    const gl::ContextScope scope(session_.context());
    if (device_ != session_.device_number()) throw gl::ContextLost("the picture was lost with its context");
    Image image(texture_.width(), texture_.height(), 4, PixelType::u8);
    gl::Framebuffer({&texture_})
        .read(0, gl::Format::rgba8, 0, 0, image.width(), image.height(), image.bytes());
    gl::Context::check();
    return image;
}

void LivePicture::point_at(Vec2d pixel, bool seen) {
    pointer_ = pixel;
    wants_surfaces_ = seen;
    if (!seen) hovered_.reset();
}

const PickBuffer& LivePicture::surfaces(Vec2i size) {
    const uint64_t version = session_.picture_version(size);
    if (!surfaces_ || surfaces_->version != version || surfaces_->buffer.size() != size) {
        const bool complete = is_complete();
        surfaces_ = {session_.pick_buffer(size), version};
        if (!complete) frames_ = 0;
    }
    return surfaces_->buffer;
}

const PickBuffer* LivePicture::known_surfaces() const {
    return surfaces_ && surfaces_->version == shown_.version ? &surfaces_->buffer : nullptr;
}

}  // namespace easypbr::app
