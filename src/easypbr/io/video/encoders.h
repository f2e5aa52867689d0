// What videos are written with, whether FFmpeg is a library or a program: kinds of files and encoders.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/io/video/video.h"

namespace easypbr::io {

/// A kind of file: FFmpeg's name, and the encoders that are tried for it.
struct Container {
    const char* name;
    std::vector<std::string> encoders;
};

/// By the extension.
Container container_of(const std::filesystem::path& path);

/// The encoder to write the file with, of those that are `there`: the one that is wanted or, when that is
/// empty, the container's first. Throws ArgumentError, naming what is there.
std::string choose_encoder(const std::filesystem::path& path, const std::string& wanted,
                           const std::vector<std::string>& there);

/// FFmpeg's names and values of the options that an encoder is opened with. Empty: it is asked for a constant
/// quality by its quantiser (`fixed_quantiser`).
std::vector<std::pair<std::string, std::string>> encoder_options(const std::string& encoder);
constexpr int fixed_quantiser = 3;

/// Throws ArgumentError for a size or a rate out of range.
void check_video_options(const std::filesystem::path& path, const VideoOptions& options);

/// Throws ArgumentError for another picture than VideoWriter::add() takes.
void check_video_picture(const std::filesystem::path& path, const Vec2i& size, const Image& picture);

}  // namespace easypbr::io
