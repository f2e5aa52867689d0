// Videos that are watched while they are made: each picture is bytes at once.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr::io {

struct VideoStreamOptions {
    Vec2i size{0, 0};       ///< of the pictures, 2 to 8192
    double fps = 30;        ///< that `rate` is counted by, above 0 to 240
    double rate = 4e6;      ///< bits per second at most, 1e4 to 1e9
    double burst = 3;       ///< frames in whose time the most bits may come at once, 1 to 240
    double quantiser = 26;  ///< x264's constant rate factor where the rate allows it, 0 to 51
};

/// One picture, coded: an access unit of H.264 in Annex B.
struct CodedPicture {
    std::vector<std::byte> bytes;
    bool is_key = false;  ///< needs none before; holds the parameter sets
};

/// A video without an end in H.264 (4:2:0, BT.709 in limited range, tagged so). No picture waits for another
/// one: no B frames, no lookahead. The first is a key frame; others are where they are asked for alone. One
/// thread at a time.
class VideoStream {
  public:
    virtual ~VideoStream() = default;
    /// Codes a u8 picture of the stream's size with 4 channels, row 0 on top; alpha is left out. Odd sides
    /// get their last row or column twice. Throws ArgumentError for another picture, Error when the encoder
    /// fails.
    virtual CodedPicture add(const Image& picture, bool as_key) = 0;
    /// From the next picture on. Throws ArgumentError out of range.
    virtual void set_rate(double bits_per_second) = 0;
    /// FFmpeg's name of the encoder.
    virtual std::string encoder() const = 0;
};

/// By NVENC where the machine has it, else by x264 (superfast, zerolatency). Throws FormatError when FFmpeg's
/// libraries or both encoders are missing, ArgumentError for options out of range.
std::unique_ptr<VideoStream> open_video_stream(const VideoStreamOptions& options);

}  // namespace easypbr::io
