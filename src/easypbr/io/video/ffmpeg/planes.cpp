#include "easypbr/io/video/ffmpeg/planes.h"

#include <algorithm>

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace easypbr::io {

void silence_ffmpeg() {
    if (av_log_get_level() == AV_LOG_INFO) av_log_set_level(AV_LOG_QUIET);
}

void describe_pictures(AVCodecContext& codec, AVPixelFormat format, Vec2i size) {
    const AVPixFmtDescriptor& planes = *av_pix_fmt_desc_get(format);
    codec.pix_fmt = format;
    codec.width = size.x() + (size.x() & (planes.log2_chroma_w ? 1 : 0));
    codec.height = size.y() + (size.y() & (planes.log2_chroma_h ? 1 : 0));
    if ((planes.flags & AV_PIX_FMT_FLAG_RGB) || format == AV_PIX_FMT_PAL8) return;
    codec.color_range = format == AV_PIX_FMT_YUVJ420P ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    codec.color_primaries = AVCOL_PRI_BT709;
    codec.color_trc = AVCOL_TRC_BT709;
    codec.colorspace = AVCOL_SPC_BT709;
}

FrameHandle frame_for(const AVCodecContext& codec) {
    FrameHandle frame(av_frame_alloc());
    if (!frame) return nullptr;
    frame->format = codec.pix_fmt;
    frame->width = codec.width;
    frame->height = codec.height;
    frame->color_range = codec.color_range;
    frame->color_primaries = codec.color_primaries;
    frame->color_trc = codec.color_trc;
    frame->colorspace = codec.colorspace;
    return av_frame_get_buffer(frame.get(), 0) < 0 ? nullptr : std::move(frame);
}

ToPlanes::ToPlanes(const AVCodecContext& codec, int scaling)
    : size_(codec.width, codec.height),
      scaler_(sws_getContext(codec.width, codec.height, AV_PIX_FMT_RGBA, codec.width, codec.height,
                             codec.pix_fmt, scaling, nullptr, nullptr, nullptr)) {
    const int* matrix = sws_getCoefficients(SWS_CS_ITU709);
    const int full_range = codec.color_range == AVCOL_RANGE_JPEG;
    sws_setColorspaceDetails(scaler_.get(), matrix, 1, matrix, full_range, 0, 1 << 16, 1 << 16);
}

void ToPlanes::fill(const Image& picture, AVFrame& frame) {
    const bool fits = picture.width() == size_.x() && picture.height() == size_.y();
    const Image& source = fits ? picture : padded(picture);
    const uint8_t* planes[1] = {source.pixels<uint8_t>().data()};
    const int strides[1] = {4 * size_.x()};
    sws_scale(scaler_.get(), planes, strides, 0, size_.y(), frame.data, frame.linesize);
}

const Image& ToPlanes::padded(const Image& picture) {
    if (padded_.empty()) padded_ = Image(size_.x(), size_.y(), 4, PixelType::u8);
    const int width = picture.width(), height = picture.height();
    for (int y = 0; y < size_.y(); ++y) {
        uint8_t* to = padded_.at<uint8_t>(0, y);
        const uint8_t* from = picture.at<uint8_t>(0, std::min(y, height - 1));
        std::copy_n(from, 4 * width, to);
        if (size_.x() > width) std::copy_n(from + 4 * (width - 1), 4, to + 4 * width);
    }
    return padded_;
}

}  // namespace easypbr::io
