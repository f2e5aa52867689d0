// VideoDownloads: videos that clients record, in a folder of their own, handed over as bytes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "easypbr/app/live_drawing.h"
#include "easypbr/remote/clients.h"

namespace easypbr::remote {

/// What a client may choose; the server names the file.
struct VideoForm {
    std::string format = "mp4";  ///< one of VideoDownloads::formats()
    Vec2i size{1280, 720};
    int fps = 30;
};

/// Used by the view's thread. The folder is the user's alone, and ends with this.
class VideoDownloads {
  public:
    /// The drawing must outlive it.
    explicit VideoDownloads(app::LiveDrawing& live) : live_(live) {}
    ~VideoDownloads() { clear(); }
    VideoDownloads(const VideoDownloads&) = delete;
    VideoDownloads& operator=(const VideoDownloads&) = delete;

    static const std::vector<std::string>& formats();

    VideoForm form;
    /// What the next frame begins: Recording::video or Recording::path. Throws FileError where there is no
    /// folder for it.
    void begin(app::LiveWishes::Recording what);
    void stop() { live_.wishes().recording = app::LiveWishes::Recording::stop; }
    /// After a frame: ends what has become too long. Returns whether a recording has come to its end and can
    /// be fetched.
    bool advance();
    bool can_fetch() const { return made_.has_value(); }
    /// The last video. Throws FileError when it cannot be read, ArgumentError when there is none.
    Picture fetch(uint32_t frame) const;
    /// Removes the folder.
    void clear();
    /// A text without the folder's name.
    std::string plain(std::string text) const;

    /// Of a recording.
    static constexpr int most_frames = 18000;
    static constexpr uint64_t most_bytes = uint64_t(256) << 20;
    static constexpr int least_side = 16, most_side = 3840, most_fps = 60;

  private:
    std::filesystem::path file() const;

    app::LiveDrawing& live_;
    std::filesystem::path folder_;
    bool runs_ = false;
    std::optional<std::string> made_;  ///< the format of what is there
};

}  // namespace easypbr::remote
