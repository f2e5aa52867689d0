// Recorder: pictures of a session as files, one by one or as a recording of many frames.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "easypbr/app/clock.h"
#include "easypbr/app/picture.h"
#include "easypbr/scene/camera_path.h"

namespace easypbr {
struct SceneSnapshot;
}

namespace easypbr::app {

class AnimationPlayer;
class Session;

struct RecordingOptions {
    std::optional<double> fps = std::nullopt;   ///< frames per second; none: 30, see record_path()
    std::optional<Vec2i> size = std::nullopt;   ///< none: the settings'
    std::optional<int> samples = std::nullopt;  ///< none: the settings'
    std::string codec = {};  ///< FFmpeg's name of an encoder; empty: the usual one of the file's kind
    bool deep = false;       ///< 16 bits: PNG only

    double rate() const { return fps.value_or(30); }
};

/// Frames are read back while the next ones are drawn, and encoded and written by threads beside it, in the
/// order they were added, all of them: stop(), the recorder's end and an exception in between finish the
/// file. While it records, the clock makes steps of 1 / fps.
class Recorder {
  public:
    /// Both must outlive the recorder.
    Recorder(Session& session, Clock& clock);
    /// Finishes a recording; a failure is logged.
    ~Recorder();
    Recorder(Recorder&&) noexcept;

    /// One picture (PNG, JPEG, HDR, EXR; `deep`: a PNG with 16 bits), written when the call returns. The
    /// target is checked before anything is drawn; it appears whole or not at all. Returns the path. Throws
    /// FileError, ArgumentError, ContextError.
    std::filesystem::path record(const std::filesystem::path& path, const PictureOptions& options = {},
                                 bool deep = false);

    /// Begins a recording: a video (MP4, MOV, MKV, WebM, GIF) or numbered pictures ("out/frame_%04d.png", or
    /// a folder), by the name. The size stays what it is now. Throws ArgumentError when one is going on
    /// already, and, before anything is drawn, when the recording cannot be written there: FileError;
    /// ArgumentError for an extension that is no video's and no picture's, a picture's name without a number
    /// (%04d), an encoder that is not there, transparency where the file has none, and a rate that is not
    /// above 0; FormatError when the module for videos is missing.
    void start(const std::filesystem::path& path, const RecordingOptions& options = {});
    bool is_recording() const { return recording_ != nullptr; }
    /// Frames added since start().
    int frame_count() const;

    /// Draws the scene as it is as the next frame, or the next `times` frames, and lets the clock make as
    /// many steps. Throws ArgumentError when nothing is recorded; what writing an earlier frame threw,
    /// whereupon the recording ends.
    void add_frame(int times = 1);
    /// A picture as the next frame, of the recording's size. Videos, PNG and JPEG get floats as sRGB.
    void add_frame(Image picture);

    /// Calls `watcher` with every picture of the recording that is going on, once it has been read, before it
    /// is handed on to be written.
    using Watcher = std::function<void(const Image& picture)>;
    void watch(Watcher watcher);

    /// Waits until all frames are written and finishes the file. Returns how many there are; 0 when nothing
    /// was being recorded. A recording without frames leaves no file and is a warning. Throws what writing
    /// threw.
    int stop();

    /// Called before a frame is drawn with its number, how many there are, and its time on the path.
    using BeforeFrame = std::function<void(int frame, int count, double time_s)>;
    /// Records the camera on its way: path.frame_times(fps), or `frames` times evenly over the path, which
    /// last as long as it where no rate is given. The camera is afterwards what it was. The first frame's
    /// motion is that of a closed path, and of objects that before_frame() moves; an open path begins at
    /// rest. Progress with the time left is reported (report_progress()). Returns the number of frames.
    /// Throws as start() and add_frame() do; what was recorded until then is finished.
    int record_path(const CameraPath& path, const std::filesystem::path& file,
                    const RecordingOptions& options = {}, std::optional<int> frames = std::nullopt,
                    const BeforeFrame& before_frame = {});

    /// The camera at a time, in seconds.
    using CameraAt = std::function<Camera(double time_s)>;
    /// Records one frame at each of `times_s`, with the camera of that time. `before_s`: where the camera was
    /// before the first frame. The rest is as for record_path(). Throws ArgumentError when there is no time.
    int record_frames(const std::vector<double>& times_s, double before_s, const CameraAt& camera,
                      const std::filesystem::path& file, const RecordingOptions& options = {},
                      const BeforeFrame& before_frame = {});

  private:
    struct Recording;
    Recording& require_recording();
    std::unique_ptr<Recording> end();
    /// What `add` throws ends the recording.
    void add_guarded(const std::function<void()>& add);

    Session& session_;
    Clock& clock_;
    std::unique_ptr<Recording> recording_;
};

/// A turn around the content's middle, once around the up axis, from the session's camera on. While the
/// camera is automatic it is far enough away for the content to stay in the picture all the way around.
CameraPath turntable(Session& session, double duration_s);
/// The same around content that is seen over some time, as one, in place of the scene's.
CameraPath turntable(Session& session, double duration_s, const SceneSnapshot& content);
/// The same around what the scene shows in the next `duration_s` seconds of the player's clock: what an
/// animation that plays moves stays in the picture too. The meshes are afterwards where they were.
CameraPath turntable(Session& session, double duration_s, AnimationPlayer& player);

}  // namespace easypbr::app
