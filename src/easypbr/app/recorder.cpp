#include "easypbr/app/recorder.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "easypbr/app/kept_camera.h"
#include "easypbr/app/output.h"
#include "easypbr/app/picture_ring.h"
#include "easypbr/app/recording_target.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/step_progress.h"
#include "easypbr/io/video/video.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
struct Recorder::Recording {
    std::filesystem::path path;
    PictureOptions picture;
    std::unique_ptr<FrameQueue> queue;
    std::unique_ptr<PictureRing> ring;  ///< what is drawn, and not in the queue yet
    Watcher watcher;
    std::optional<double> step_before;  ///< the clock's, before the recording

    void take(Image picture, int times);
    /// All that is drawn is written, and the file finished. Throws the first failure.
    void finish();
};

Recorder::Recorder(Session& session, Clock& clock) : session_(session), clock_(clock) {}
Recorder::Recorder(Recorder&&) noexcept = default;

Recorder::~Recorder() {
    try {
        stop();
    } catch (const std::exception& error) {
        log_warning(error.what());
    }
}

fs::path Recorder::record(const fs::path& path, const PictureOptions& options, bool deep) {
    return render_to_file(session_, path, options, deep);
}

void Recorder::watch(Watcher watcher) {
    require_recording().watcher = std::move(watcher);
}

void Recorder::start(const fs::path& path, const RecordingOptions& options) {
    if (recording_)
        throw ArgumentError(fmt::format("cannot record {}: {} is being recorded; stop() that first",
                                        path.string(), recording_->path.string()));
    check_recording(path, session_.settings(), options);
    auto recording = std::make_unique<Recording>();
    recording->path = path;
    recording->picture = {options.size.value_or(session_.settings().image.size), options.samples,
                          encoding_for_recording(path, options.deep)};
    recording->queue =
        std::make_unique<FrameQueue>(make_frame_writer(path, *recording->picture.size, options));
    recording->ring = std::make_unique<PictureRing>(
        session_, [to = recording.get()](Image drawn, int times) { to->take(std::move(drawn), times); });
    recording->step_before = clock_.fixed_step();
    clock_.set_fixed_step(1 / options.rate());
    recording_ = std::move(recording);
}

int Recorder::frame_count() const {
    return recording_ ? recording_->queue->count() + recording_->ring->count() : 0;
}

Recorder::Recording& Recorder::require_recording() {
    if (!recording_) throw ArgumentError("nothing is being recorded: call start() first");
    return *recording_;
}

void Recorder::Recording::take(Image picture, int times) {
    if (watcher) watcher(picture);
    for (int i = 1; i < times; ++i) queue->push(picture);
    queue->push(std::move(picture));
}

void Recorder::Recording::finish() {
    std::exception_ptr failure;
    try {
        ring->drain();
    } catch (...) {
        failure = std::current_exception();
    }
    try {
        queue->finish();
    } catch (...) {
        if (!failure) failure = std::current_exception();
    }
    if (failure) std::rethrow_exception(failure);
}

void Recorder::add_guarded(const std::function<void()>& add) {
    try {
        add();
    } catch (...) {
        // What failed once is over; what finishing it reports would be the same again.
        const std::exception_ptr failure = std::current_exception();
        try {
            end()->finish();
        } catch (...) {
        }
        std::rethrow_exception(failure);
    }
}

void Recorder::add_frame(int times) {
    Recording& recording = require_recording();
    if (times < 1) throw ArgumentError(fmt::format("add_frame: expected 1 time or more, got {}", times));
    add_guarded([&] { recording.ring->make_room(); });
    recording.ring->draw(recording.picture, times);
    add_guarded([&] { recording.ring->take_read(); });
    for (int i = 0; i < times; ++i) clock_.end_frame();
}

void Recorder::add_frame(Image picture) {
    Recording& recording = require_recording();
    const Vec2i size = *recording.picture.size;
    if (picture.width() != size.x() || picture.height() != size.y())
        throw ArgumentError(fmt::format("{}: expected frames of {}x{}, got {}x{}", recording.path.string(),
                                        size.x(), size.y(), picture.width(), picture.height()));
    if (io::is_video(recording.path)) picture = to_u8(picture);
    add_guarded([&] {
        recording.ring->drain();
        recording.queue->push(picture.channels() == 4 ? std::move(picture) : with_channels(picture, 4));
    });
    clock_.end_frame();
}

std::unique_ptr<Recorder::Recording> Recorder::end() {
    clock_.set_fixed_step(recording_->step_before);
    clock_.set_time(clock_.time());  // The frame there is yet to come.
    return std::move(recording_);
}

int Recorder::stop() {
    if (!recording_) return 0;
    const std::unique_ptr<Recording> recording = end();
    recording->finish();
    const int count = recording->queue->count();
    if (count == 0)
        log_warning(fmt::format("{}: no frame was added, so nothing was recorded", recording->path.string()));
    return count;
}

int Recorder::record_path(const CameraPath& path, const fs::path& file, const RecordingOptions& options,
                          std::optional<int> frames, const BeforeFrame& before_frame) {
    const std::vector<double> times = frames ? path.times(*frames) : path.frame_times(options.rate());
    RecordingOptions timed = options;
    if (frames && !options.fps) timed.fps = path.frame_rate(*frames);
    const Camera like = session_.resolve(options.size).camera;
    // A closed path was on its way before the first frame; on an open one the camera rests until then.
    const double step = times.size() > 1 ? times[1] - times[0] : 1 / timed.rate();
    return record_frames(
        times, times[0] - step, [&](double time_s) { return path.camera(time_s, like); }, file, timed,
        before_frame);
}

int Recorder::record_frames(const std::vector<double>& times_s, double before_s, const CameraAt& camera,
                            const fs::path& file, const RecordingOptions& options,
                            const BeforeFrame& before_frame) {
    if (times_s.empty()) throw ArgumentError(fmt::format("{}: there is no frame to record", file.string()));
    const KeptCamera kept(session_);
    start(file, options);
    StepProgress progress(file.filename().string(), "frame", int(times_s.size()), 0.2);
    session_.begin_motion(camera(before_s));
    try {
        for (size_t i = 0; i < times_s.size(); ++i) {
            progress.done(int(i));
            if (before_frame) before_frame(int(i), int(times_s.size()), times_s[i]);
            session_.set_camera(camera(times_s[i]));
            add_frame();
        }
    } catch (...) {
        if (recording_) try {
                stop();
            } catch (const std::exception& error) {
                log_warning(error.what());
            }
        throw;
    }
    return stop();
}

}  // namespace easypbr::app
