#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/file_set.h"
#include "easypbr/core/log.h"
#include "easypbr/io/source/module_loader.h"
#include "easypbr/io/video/encoders.h"
#include "easypbr/io/video/ffmpeg/module.h"
#include "easypbr/io/video/ffmpeg_program.h"
#include "easypbr/io/video/video.h"
#include "easypbr/io/video/video_file.h"
#include "easypbr/io/video/video_stream.h"

namespace easypbr::io {
namespace {

constexpr const char* video_file = "libeasypbr_ffmpeg.so";

struct VideoModule : RuntimeModule {
    VideoModule() : RuntimeModule(video_file) {
        find(open, "easypbr_ffmpeg_open");
        find(check, "easypbr_ffmpeg_check");
        find(encoders, "easypbr_ffmpeg_encoders");
        find(open_stream, "easypbr_ffmpeg_open_stream");
    }

    bool works() const { return reason().empty(); }

    decltype(&easypbr_ffmpeg_open) open = nullptr;
    decltype(&easypbr_ffmpeg_check) check = nullptr;
    decltype(&easypbr_ffmpeg_encoders) encoders = nullptr;
    decltype(&easypbr_ffmpeg_open_stream) open_stream = nullptr;
};

const VideoModule& ffmpeg_module() {
    static const VideoModule loaded;
    return loaded;
}

std::string how_to_get() {
    return fmt::format(
        "FFmpeg's libraries cannot be loaded ({}), and there is no program ffmpeg; install ffmpeg (Debian: "
        "apt install ffmpeg), or for Python: pip install imageio-ffmpeg",
        ffmpeg_module().reason());
}

fs::path require_program(const fs::path& path) {
    if (fs::path program = ffmpeg_program(); !program.empty()) return program;
    throw FormatError(fmt::format("cannot write {}: {}; or write pictures: out/frame_%04d.png", path.string(),
                                  how_to_get()));
}

std::unique_ptr<VideoWriter> open_in(VideoFile file, const VideoOptions& options) {
    if (!ffmpeg_module().works()) {
        const fs::path program = require_program(file.name());
        return open_video_by_program(program, std::move(file), options);
    }
    std::unique_ptr<VideoWriter> writer;
    ffmpeg_module().open(std::move(file), options, writer);
    return writer;
}

/// A video that takes the place of a file when it is whole.
class ReplacingVideo final : public VideoWriter {
  public:
    ReplacingVideo(const fs::path& target, VideoFile part, const VideoOptions& options)
        : target_(target), part_(part.path()), video_(open_in(std::move(part), options)) {}

    ~ReplacingVideo() override {
        try {
            finish();
        } catch (const Error& error) {
            log_warning(error.what());
        }
    }

    void add(const Image& picture) override { video_->add(picture); }

    void finish() override {
        if (finished_) return;
        finished_ = true;
        video_->finish();
        // What failed, or has no picture, was removed.
        if (!fs::exists(part_)) return;
        if (is_being_recorded(target_))
            throw FileError(
                fmt::format("cannot write {}: it is being recorded meanwhile; this recording is {}",
                            target_.string(), part_.string()));
        replace_file(target_, part_);
    }

  private:
    fs::path target_, part_;
    std::unique_ptr<VideoWriter> video_;
    bool finished_ = false;
};

}  // namespace

std::vector<std::string> video_extensions() {
    return {"gif", "m4v", "mkv", "mov", "mp4", "webm"};
}

bool is_video(const fs::path& path) {
    return std::ranges::count(video_extensions(), extension_of(path)) > 0;
}

void check_video(const fs::path& path, const std::string& codec) {
    if (ffmpeg_module().works())
        ffmpeg_module().check(path, codec);
    else
        choose_encoder(path, codec, encoders_of_program(require_program(path)));
}

std::unique_ptr<VideoWriter> open_video(const fs::path& path, const VideoOptions& options) {
    check_writable(path);
    if (auto file = VideoFile::create(path)) return open_in(std::move(*file), options);
    const fs::path target = real_target(path);
    if (is_being_recorded(target))
        throw FileError(fmt::format("cannot write {}: it is being recorded", path.string()));
    return std::make_unique<ReplacingVideo>(target, VideoFile::create_part(target, path), options);
}

std::unique_ptr<VideoStream> open_video_stream(const VideoStreamOptions& options) {
    if (!ffmpeg_module().works())
        throw FormatError(
            fmt::format("no video can be streamed: FFmpeg's libraries cannot be loaded ({}); Debian: apt "
                        "install libavcodec59 libavformat59 libswscale6",
                        ffmpeg_module().reason()));
    std::unique_ptr<VideoStream> stream;
    ffmpeg_module().open_stream(options, stream);
    return stream;
}

std::vector<std::string> video_encoders() {
    std::vector<std::string> names;
    if (ffmpeg_module().works())
        ffmpeg_module().encoders(names);
    else if (const fs::path program = ffmpeg_program(); !program.empty())
        names = encoders_of_program(program);
    return names;
}

std::string video_support() {
    if (ffmpeg_module().works()) return "written by FFmpeg's libraries";
    const fs::path program = ffmpeg_program();
    return program.empty() ? "not written: " + how_to_get()
                           : fmt::format("written by the program {}", program.string());
}

}  // namespace easypbr::io
