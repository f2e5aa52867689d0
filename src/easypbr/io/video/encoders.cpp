#include "easypbr/io/video/encoders.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"

namespace easypbr::io {

Container container_of(const fs::path& path) {
    const std::string extension = extension_of(path);
    if (extension == "gif") return {"gif", {"gif"}};
    if (extension == "webm") return {"webm", {"libvpx-vp9", "libvpx"}};
    if (extension == "mkv") return {"matroska", {"libx264", "libopenh264"}};
    if (extension == "mov") return {"mov", {"libx264", "libopenh264"}};
    return {"mp4", {"libx264", "libopenh264"}};
}

std::string choose_encoder(const fs::path& path, const std::string& wanted,
                           const std::vector<std::string>& there) {
    const Container container = container_of(path);
    for (const std::string& name : wanted.empty() ? container.encoders : std::vector<std::string>{wanted})
        if (std::ranges::count(there, name)) return name;
    throw ArgumentError(fmt::format(
        "cannot write {}: FFmpeg has no encoder {} for it; it has {}", path.string(),
        wanted.empty() ? fmt::format("{}", fmt::join(container.encoders, " or ")) : "'" + wanted + "'",
        there.empty() ? "none" : fmt::format("{}", fmt::join(there, ", "))));
}

std::vector<std::pair<std::string, std::string>> encoder_options(const std::string& encoder) {
    if (encoder == "libx264") return {{"preset", "superfast"}, {"crf", "17"}, {"x264-params", "log=-1"}};
    // It prints by itself.
    if (encoder == "libx265")
        return {{"preset", "superfast"}, {"crf", "19"}, {"x265-params", "log-level=none"}};
    if (encoder == "libvpx-vp9")
        return {{"deadline", "realtime"}, {"cpu-used", "6"}, {"crf", "20"}, {"b", "0"}, {"row-mt", "1"}};
    if (encoder.starts_with("libvpx"))
        return {{"deadline", "realtime"}, {"cpu-used", "6"}, {"crf", "20"}, {"b", "0"}};
    return {};
}

void check_video_options(const fs::path& path, const VideoOptions& options) {
    if (options.size.minCoeff() < 2 || options.size.maxCoeff() > 16384)
        throw ArgumentError(fmt::format("cannot write {}: expected a size from 2x2 to 16384x16384, got {}x{}",
                                        path.string(), options.size.x(), options.size.y()));
    const double most = extension_of(path) == "gif" ? 50 : 1000;
    if (!(options.fps > 0 && options.fps <= most))
        throw ArgumentError(
            fmt::format("cannot write {}: expected above 0 and at most {} frames per second, got {}",
                        path.string(), most, options.fps));
}

void check_video_picture(const fs::path& path, const Vec2i& size, const Image& picture) {
    if (picture.width() != size.x() || picture.height() != size.y() || picture.channels() != 4 ||
        picture.type() != PixelType::u8)
        throw ArgumentError(fmt::format(
            "{}: expected pictures of {}x{} with 4 channels of 8 bits, got {}x{} with {}", path.string(),
            size.x(), size.y(), picture.width(), picture.height(), picture.channels()));
}

}  // namespace easypbr::io
