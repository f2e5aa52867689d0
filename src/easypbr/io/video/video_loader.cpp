#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/source/module_loader.h"
#include "easypbr/io/video/ffmpeg/module.h"
#include "easypbr/io/video/video.h"

namespace easypbr::io {
namespace {

constexpr const char* video_file = "libeasypbr_ffmpeg.so";

struct VideoModule : RuntimeModule {
    VideoModule() : RuntimeModule(video_file) {
        find(open, "easypbr_ffmpeg_open");
        find(check, "easypbr_ffmpeg_check");
        find(encoders, "easypbr_ffmpeg_encoders");
    }

    decltype(&easypbr_ffmpeg_open) open = nullptr;
    decltype(&easypbr_ffmpeg_check) check = nullptr;
    decltype(&easypbr_ffmpeg_encoders) encoders = nullptr;
};

const VideoModule& ffmpeg_module() {
    static const VideoModule loaded;
    return loaded;
}

const VideoModule& require_module(const fs::path& path) {
    const VideoModule& ffmpeg = ffmpeg_module();
    if (!ffmpeg.reason().empty())
        throw FormatError(fmt::format(
            "cannot write {}: videos are written by the FFmpeg module, which cannot be loaded ({}); install "
            "the packages libavcodec59, libavformat59 and libswscale6 and keep {} beside libeasypbr.so, or "
            "write "
            "pictures: out/frame_%04d.png",
            path.string(), ffmpeg.reason(), video_file));
    return ffmpeg;
}

}  // namespace

std::vector<std::string> video_extensions() {
    return {"gif", "m4v", "mkv", "mov", "mp4", "webm"};
}

bool is_video(const fs::path& path) {
    return std::ranges::count(video_extensions(), extension_of(path)) > 0;
}

void check_video(const fs::path& path, const std::string& codec) {
    require_module(path).check(path, codec);
}

std::unique_ptr<VideoWriter> open_video(const fs::path& path, const VideoOptions& options) {
    std::unique_ptr<VideoWriter> writer;
    require_module(path).open(path, options, writer);
    return writer;
}

std::vector<std::string> video_encoders() {
    std::vector<std::string> names;
    if (ffmpeg_module().reason().empty()) ffmpeg_module().encoders(names);
    return names;
}

}  // namespace easypbr::io
