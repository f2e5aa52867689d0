// What the module exports; libeasypbr finds the functions by name.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/io/video/video.h"
#include "easypbr/io/video/video_file.h"
#include "easypbr/io/video/video_stream.h"

extern "C" {
/// Throw as easypbr::io::open_video() does.
void easypbr_ffmpeg_open(easypbr::io::VideoFile&& file, const easypbr::io::VideoOptions& options,
                         std::unique_ptr<easypbr::io::VideoWriter>& out);
void easypbr_ffmpeg_check(const std::filesystem::path& path, const std::string& codec);
void easypbr_ffmpeg_encoders(std::vector<std::string>& out);
/// Throws as easypbr::io::open_video_stream() does.
void easypbr_ffmpeg_open_stream(const easypbr::io::VideoStreamOptions& options,
                                std::unique_ptr<easypbr::io::VideoStream>& out);
}
