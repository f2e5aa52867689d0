// RGBA pictures as the planes that an encoder takes.
#pragma once

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"
#include "easypbr/io/video/ffmpeg/handles.h"

namespace easypbr::io {

/// Silences FFmpeg, which would print; what a program has chosen itself stays.
void silence_ffmpeg();

/// Has the encoder take pictures of this size in this format: sides are made even where planes of half the
/// size need that, and colours are those of BT.709, in limited range but for JPEG's formats.
void describe_pictures(AVCodecContext& codec, AVPixelFormat format, Vec2i size);

/// A frame for the encoder's pictures; null without memory.
FrameHandle frame_for(const AVCodecContext& codec);

/// Converts pictures to an encoder's planes. Sides that were made even get their last row or column twice.
class ToPlanes {
  public:
    /// `scaling`: libswscale's flags, for the planes of half the size. The encoder's format is no palette.
    ToPlanes(const AVCodecContext& codec, int scaling);
    /// `picture`: u8, 4 channels, of the size that the encoder was described by. The frame must be writable.
    void fill(const Image& picture, AVFrame& frame);

  private:
    const Image& padded(const Image& picture);

    Vec2i size_;
    Scaler scaler_;
    Image padded_;
};

}  // namespace easypbr::io
