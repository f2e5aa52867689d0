// What a person records while looking: a picture, what happens, a camera path; a step with every frame that
// is shown, so that it stays alive meanwhile.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/recorder.h"

namespace easypbr {
struct Settings;
}

namespace easypbr::app {

/// What is asked for.
struct RecordingForm {
    std::string picture = "picture.png", video = "recording.mp4";
    Vec2i size{0, 0};  ///< 0: the settings' picture size
    double fps = 30;
    bool transparent = false;  ///< nothing in place of the background
    bool panels = false;       ///< the window as it is, panels and all, in its own size
};

class LiveRecording {
  public:
    /// The window's content: drawn to its end for the camera as it is, or as it is shown.
    using Screen = std::function<Image()>;

    /// All must outlive it.
    LiveRecording(Session& session, Recorder& recorder) : session_(session), recorder_(recorder) {}

    /// Writes one picture at once. Returns what it was written to. Throws as Recorder::record().
    std::string picture(const RecordingForm& form, const Screen& screen);
    /// Begins a video of what happens, in real time: each frame as often as its time asks for, in one sample.
    /// Throws as Recorder::start().
    void start(const RecordingForm& form, Vec2i window);
    /// Begins to record the camera on its way, a frame with every advance(), in full quality.
    void start_path(const RecordingForm& form, Vec2i window, const CameraPath& path);
    /// The next frame or frames. Throws what drawing and writing threw, and ArgumentError when a window that
    /// is recorded with its panels was resized; the recording is then over, and its file finished.
    void advance(const Screen& finished, const Screen& shown);
    /// Finishes the file and puts the camera back. Returns the number of frames. Throws what writing threw.
    int stop();

    bool is_running() const { return running_.has_value(); }
    bool is_path() const { return running_ && running_->path; }
    /// What is recorded to; empty when nothing is.
    std::string file() const { return running_ ? running_->form.video : std::string(); }
    int frames() const { return running_ ? running_->frames : 0; }
    /// Of a path; 0 of what has no end.
    int total() const { return running_ ? int(running_->times.size()) : 0; }
    double seconds_left() const;
    /// Where the camera of a path is a frame before the next one.
    std::optional<Camera> camera_before() const;
    /// The newest frame of a path without panels that has been read back, to be shown meanwhile.
    const Image& frame() const { return frame_; }

  private:
    using Steady = std::chrono::steady_clock;
    struct Running {
        RecordingForm form;
        Vec2i size;
        std::optional<CameraPath> path;
        std::vector<double> times;
        Camera like;
        std::shared_ptr<const Settings> settings_before;  ///< of a recording that moves the camera
        int frames = 0;
        Steady::time_point begun = Steady::now();
    };
    void begin(const RecordingForm& form, Vec2i window, std::optional<int> samples);
    void add_path_frame(const Screen& finished);
    void add_live_frames(const Screen& shown);
    void draw_frame(int times);
    void end();

    Session& session_;
    Recorder& recorder_;
    std::optional<Running> running_;
    Image frame_;
};

}  // namespace easypbr::app
