// Where a recording goes: a video, or a picture for each frame.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "easypbr/app/frame_queue.h"
#include "easypbr/app/output.h"
#include "easypbr/app/recorder.h"

namespace easypbr::app {

/// The path of frame `index` for "out/frame_%04d.png" or for a folder ("out/": out/frame_00000.png).
std::filesystem::path frame_path(const std::filesystem::path& path, int index);

/// The path where nothing lies yet, else with the first number that is free: "recording_2.mp4",
/// "out/frame_%04d_2.png", "out_2/". For one picture, and for a recording.
std::filesystem::path free_picture(const std::filesystem::path& path);
std::filesystem::path free_recording(const std::filesystem::path& path);

/// Whether it is a video's name or numbered pictures': "out.mp4", "out/frame_%04d.png", or a folder for them:
/// "out/", "out".
bool is_recording_name(const std::filesystem::path& path);

/// What the frames must be drawn as.
Encoding encoding_for_recording(const std::filesystem::path& path, bool deep);

/// Throws ArgumentError for what the name alone shows: an extension that is no video's and no picture's, a
/// picture's name without a number (%04d).
void check_recording_name(const std::filesystem::path& path);

/// Throws, before anything is drawn, when the recording cannot be written there: FileError; ArgumentError as
/// check_recording_name(), and for an encoder that is not there, transparency where the file has none, and a
/// rate that is not above 0; FormatError when the module for videos is missing.
void check_recording(const std::filesystem::path& path, const Settings& settings,
                     const RecordingOptions& options);

/// A writer for frames of that size; makes the folder of pictures. Throws as check_recording() does.
std::unique_ptr<FrameWriter> make_frame_writer(const std::filesystem::path& path, const Vec2i& size,
                                               const RecordingOptions& options);

}  // namespace easypbr::app
