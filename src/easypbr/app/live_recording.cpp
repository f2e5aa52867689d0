#include "easypbr/app/live_recording.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "easypbr/app/output.h"
#include "easypbr/core/error.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

/// After a pause as long as this a video of what happens goes on without it.
constexpr double longest_pause = 2;

/// Leaves the background out for a scope.
class WithoutBackground {
  public:
    WithoutBackground(Settings& settings, bool without)
        : settings_(settings), before_(settings.background.mode) {
        if (without) settings_.background.mode = BackgroundMode::transparent;
    }
    ~WithoutBackground() { settings_.background.mode = before_; }
    WithoutBackground(const WithoutBackground&) = delete;
    WithoutBackground& operator=(const WithoutBackground&) = delete;

  private:
    Settings& settings_;
    BackgroundMode before_;
};

Vec2i recording_size(const RecordingForm& form, Vec2i window, const Settings& settings) {
    if (form.panels) return window;
    return form.size.minCoeff() > 0 ? form.size : settings.image.size;
}

/// A frame with panels. Throws when the window no longer has the size of the recording.
Image panels_frame(const LiveRecording::Screen& screen, Vec2i size, const std::string& file) {
    Image frame = screen();
    if (frame.width() != size.x() || frame.height() != size.y())
        throw ArgumentError(
            fmt::format("{} ends here: the window was resized from {}x{} to {}x{} during its recording", file,
                        size.x(), size.y(), frame.width(), frame.height()));
    return frame;
}

}  // namespace

std::string LiveRecording::picture(const RecordingForm& form, const Screen& screen) {
    if (form.panels) {
        check_picture(form.picture, session_.settings());
        io::save_image(screen(), form.picture);
        return form.picture;
    }
    const WithoutBackground without(session_.settings(), form.transparent);
    return recorder_.record(form.picture, {recording_size(form, {0, 0}, session_.settings()), {}}).string();
}

void LiveRecording::begin(const RecordingForm& form, Vec2i window, std::optional<int> samples) {
    if (running_) throw ArgumentError("a recording is going on: stop it first");
    const Vec2i size = recording_size(form, window, session_.settings());
    {
        const WithoutBackground without(session_.settings(), form.transparent && !form.panels);
        recorder_.start(form.video, {.fps = form.fps, .size = size, .samples = samples});
    }
    running_ = Running();
    running_->form = form;
    running_->size = size;
}

void LiveRecording::start(const RecordingForm& form, Vec2i window) {
    begin(form, window, 1);
}

void LiveRecording::start_path(const RecordingForm& form, Vec2i window, const CameraPath& path) {
    std::vector<double> times = path.frame_times(form.fps);
    const Camera like = session_.camera();
    begin(form, window, std::nullopt);
    recorder_.watch([this](const Image& frame) { frame_ = frame; });
    running_->path = path;
    running_->times = std::move(times);
    running_->like = like;
    running_->settings_before = std::make_shared<const Settings>(session_.settings());
    session_.begin_motion(camera_before());
}

void LiveRecording::draw_frame(int times) {
    const WithoutBackground without(session_.settings(), running_->form.transparent);
    recorder_.add_frame(times);
}

void LiveRecording::add_path_frame(const Screen& finished) {
    const double time = running_->times[size_t(running_->frames)];
    session_.set_camera(running_->path->camera(time, running_->like));
    if (running_->form.panels)
        recorder_.add_frame(panels_frame(finished, running_->size, running_->form.video));
    else
        draw_frame(1);
    ++running_->frames;
}

void LiveRecording::add_live_frames(const Screen& shown) {
    const auto due = [&] {
        const double passed = std::chrono::duration<double>(Steady::now() - running_->begun).count();
        return int(passed * running_->form.fps) + 1 - running_->frames;
    };
    int count = due();
    if (count <= 0) return;
    const int most = int(longest_pause * running_->form.fps) + 1;
    if (count > most) {
        running_->begun += std::chrono::duration_cast<Steady::duration>(
            std::chrono::duration<double>((count - most) / running_->form.fps));
        count = most;
    }
    running_->frames += count;
    if (!running_->form.panels) return draw_frame(count);
    const Image frame = panels_frame(shown, running_->size, running_->form.video);
    for (int i = 0; i < count; ++i) recorder_.add_frame(frame);
}

void LiveRecording::advance(const Screen& finished, const Screen& shown) {
    if (!running_) return;
    // The program may have stopped it.
    if (!recorder_.is_recording()) return end();
    try {
        if (running_->path)
            add_path_frame(finished);
        else
            add_live_frames(shown);
    } catch (...) {
        // Nobody else would stop the recorder; what finishing the file reports is of the same cause.
        try {
            stop();
        } catch (const std::exception&) {
        }
        throw;
    }
}

void LiveRecording::end() {
    if (running_ && running_->settings_before) session_.settings().camera = running_->settings_before->camera;
    running_.reset();
    frame_ = {};
}

int LiveRecording::stop() {
    if (!running_) return 0;
    end();
    return recorder_.stop();
}

std::optional<Camera> LiveRecording::camera_before() const {
    if (!is_path() || running_->frames >= total()) return {};
    return running_->path->camera(running_->times[size_t(running_->frames)] - 1 / running_->form.fps,
                                  running_->like);
}

double LiveRecording::seconds_left() const {
    if (!running_ || running_->frames == 0 || running_->times.empty()) return 0;
    const double passed = std::chrono::duration<double>(Steady::now() - running_->begun).count();
    return passed / running_->frames * double(running_->times.size() - size_t(running_->frames));
}

}  // namespace easypbr::app
