// Videos by the program `ffmpeg`, where FFmpeg's libraries cannot be loaded.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/io/video/video.h"
#include "easypbr/io/video/video_file.h"

namespace easypbr::io {

/// The program: from PATH, else what the finder of set_ffmpeg_finder() knows; empty: there is none.
std::filesystem::path ffmpeg_program();

/// Names of the encoders of pictures that the program has. Throws FormatError when it does not work.
std::vector<std::string> encoders_of_program(const std::filesystem::path& program);

/// As open_video(), by the program, into a file of its own. It encodes in a process of its own, which gets
/// the pictures as they are and finishes the file when this process ends, however that ends. What it says
/// about an error stands in the message of the FileError.
std::unique_ptr<VideoWriter> open_video_by_program(const std::filesystem::path& program, VideoFile file,
                                                   const VideoOptions& options);

}  // namespace easypbr::io
