// Videos: pictures in order into one file.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr::io {

struct VideoOptions {
    Vec2i size{0, 0};  ///< of the pictures; odd sides of H.264 and VP9 get their last row or column twice
    double fps = 30;
    std::string codec;  ///< FFmpeg's name of an encoder; empty: H.264 for MP4, VP9 for WebM
};

/// A video being written. One thread at a time.
class VideoWriter {
  public:
    virtual ~VideoWriter() = default;
    /// Appends a u8 picture of the video's size with 4 channels, row 0 on top; alpha is left out. Throws
    /// ArgumentError for another picture, FileError when the file cannot be written.
    virtual void add(const Image& picture) = 0;
    /// Writes what is still in the encoder and closes the file; add() may not follow. Throws FileError, also
    /// when another file has taken the place of this one, which stays as it is. A writer that is destroyed
    /// before is finished as far as it can be. A file that cannot be written to its end, or has no picture,
    /// is removed, by add() too.
    virtual void finish() = 0;
};

/// Begins a video: MP4, MOV (H.264), WebM (VP9), MKV or GIF, by the extension. Pictures are taken for sRGB
/// and written with the primaries and matrix of BT.709 in limited range, and tagged so. While it is written
/// an MP4 consists of fragments of its own, so that it can be played when the process is killed; finish()
/// makes it an ordinary file. The work is done by a module of its own (libeasypbr_ffmpeg.so, searched beside
/// libeasypbr.so and then where the system searches) or, where that or FFmpeg's libraries are missing, by the
/// program ffmpeg, which finishes the file when this process is killed. Throws FormatError when both are
/// missing, ArgumentError for a codec that is not there (naming those that are), a size or a rate out of
/// range, FileError when the file cannot be written, or another video is being written into it. A file that
/// is there already is replaced by finish(), when the video is whole: until then the video is written into a
/// new file beside it, "clip.part.mp4" beside "clip.mp4", "clip.part-2.mp4" where that is there, and so on.
std::unique_ptr<VideoWriter> open_video(const std::filesystem::path& path, const VideoOptions& options);

/// Throws as open_video() does for a codec or an FFmpeg that is missing; writes nothing.
void check_video(const std::filesystem::path& path, const std::string& codec);

/// Whether the extension is one of a video.
bool is_video(const std::filesystem::path& path);
std::vector<std::string> video_extensions();

/// Names of the encoders that are there; empty without FFmpeg.
std::vector<std::string> video_encoders();

/// What finds a program ffmpeg where PATH has none; it returns an empty path when it knows none. The Python
/// package sets one that asks imageio-ffmpeg. Called from any thread. Thread-safe.
void set_ffmpeg_finder(std::function<std::filesystem::path()> find);

/// By what videos are written here, or what to install: the end of the sentence "Videos are ...".
std::string video_support();

}  // namespace easypbr::io
