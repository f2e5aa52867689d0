#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/io/video/ffmpeg/module.h"
#include "easypbr/io/video/ffmpeg/planes.h"

namespace easypbr::io {
namespace {

using Options = std::vector<std::pair<const char*, std::string>>;

constexpr double least_rate = 1e4, most_rate = 1e9;
/// Smaller pictures are refused by NVENC.
constexpr int least_nvenc_side = 160;
/// More make slices so thin that motion across them costs bits.
constexpr int most_threads = 4;

/// Where it has failed once it is not tried again: asking a GPU without it takes half a second.
std::atomic<bool> nvenc_fails = false;

void check_options(const VideoStreamOptions& options) {
    const auto require = [](bool holds, const char* what) {
        if (!holds) throw ArgumentError(fmt::format("a video stream: {}", what));
    };
    require(options.size.minCoeff() >= 2 && options.size.maxCoeff() <= 8192,
            "expected a size from 2x2 to 8192x8192");
    require(options.fps > 0 && options.fps <= 240, "expected above 0 and at most 240 frames per second");
    require(options.rate >= least_rate && options.rate <= most_rate, "expected a rate from 1e4 to 1e9");
    require(options.burst >= 1 && options.burst <= 240, "expected a burst of 1 to 240 frames");
    require(options.quantiser >= 0 && options.quantiser <= 51, "expected a quantiser from 0 to 51");
}

Options options_of(const std::string& encoder, const VideoStreamOptions& options) {
    if (encoder == "libx264")
        return {{"preset", "superfast"},
                {"tune", "zerolatency"},
                {"crf", fmt::format("{}", options.quantiser)},
                {"forced-idr", "1"},
                // It prints by itself.
                {"x264-params", "log=-1"}};
    return {{"preset", "p1"},     {"tune", "ull"}, {"rc", "cbr"},
            {"zerolatency", "1"}, {"delay", "0"},  {"forced-idr", "1"}};
}

class FfmpegStream final : public VideoStream {
  public:
    FfmpegStream(const AVCodec& encoder, const VideoStreamOptions& options) : options_(options) {
        // One is the caller's, where the system gives no others.
        const bool has_threads = (encoder.capabilities & AV_CODEC_CAP_OTHER_THREADS) != 0;
        if (!opens(encoder, std::clamp(int(std::thread::hardware_concurrency()), 1, most_threads)) &&
            !(has_threads && opens(encoder, 1)))
            throw FormatError(fmt::format("no video can be streamed: the encoder {} does not open for {}x{}",
                                          encoder.name, codec_->width, codec_->height));
        frame_ = frame_for(*codec_);
        packet_.reset(av_packet_alloc());
        require(frame_ && packet_ ? 0 : AVERROR(ENOMEM));
        planes_.emplace(*codec_, SWS_POINT);
    }

    CodedPicture add(const Image& picture, bool as_key) override {
        if (picture.width() != options_.size.x() || picture.height() != options_.size.y() ||
            picture.channels() != 4 || picture.type() != PixelType::u8)
            throw ArgumentError(fmt::format(
                "a video stream: expected pictures of {}x{} with 4 channels of 8 bits, got "
                "{}x{} with {}",
                options_.size.x(), options_.size.y(), picture.width(), picture.height(), picture.channels()));
        require(av_frame_make_writable(frame_.get()));
        planes_->fill(picture, *frame_);
        frame_->pts = next_++;
        frame_->pict_type = as_key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
        require(avcodec_send_frame(codec_.get(), frame_.get()));
        require(avcodec_receive_packet(codec_.get(), packet_.get()));
        const auto* bytes = reinterpret_cast<const std::byte*>(packet_->data);
        CodedPicture coded{{bytes, bytes + packet_->size}, (packet_->flags & AV_PKT_FLAG_KEY) != 0};
        av_packet_unref(packet_.get());
        return coded;
    }

    void set_rate(double bits_per_second) override {
        options_.rate = bits_per_second;
        check_options(options_);
        use_rate(bits_per_second);
        if (codec_->bit_rate > 0) codec_->bit_rate = codec_->rc_max_rate;
    }

    std::string encoder() const override { return codec_->codec->name; }

  private:
    static int require(int code) {
        if (code >= 0) return code;
        char reason[AV_ERROR_MAX_STRING_SIZE]{};
        av_strerror(code, reason, sizeof reason);
        throw Error(fmt::format("a picture was not coded: {}", reason));
    }

    /// Encoders look at these before each picture.
    void use_rate(double rate) {
        codec_->rc_max_rate = int64_t(rate);
        codec_->rc_buffer_size =
            int(std::min(rate / options_.fps * options_.burst, double(std::numeric_limits<int>::max())));
        codec_->rc_initial_buffer_occupancy = codec_->rc_buffer_size;
    }

    void describe() {
        describe_pictures(*codec_, AV_PIX_FMT_YUV420P, options_.size);
        codec_->framerate = av_d2q(options_.fps, 100000);
        codec_->time_base = av_inv_q(codec_->framerate);
        codec_->gop_size = 1 << 30;
        codec_->max_b_frames = 0;
        use_rate(options_.rate);
        // NVENC aims at it; x264 would no longer hold the quality constant.
        if (encoder() != "libx264") codec_->bit_rate = codec_->rc_max_rate;
    }

    bool opens(const AVCodec& encoder, int threads) {
        codec_.reset(avcodec_alloc_context3(&encoder));
        describe();
        codec_->thread_count = threads;
        AVDictionary* wanted = nullptr;
        for (const auto& [name, value] : options_of(encoder.name, options_))
            av_dict_set(&wanted, name, value.c_str(), 0);
        const int opened = avcodec_open2(codec_.get(), &encoder, &wanted);
        av_dict_free(&wanted);
        return opened >= 0;
    }

    VideoStreamOptions options_;
    Codec codec_;
    FrameHandle frame_;
    Packet packet_;
    std::optional<ToPlanes> planes_;
    int64_t next_ = 0;
};

std::unique_ptr<VideoStream> open_nvenc(const VideoStreamOptions& options) {
    const AVCodec* encoder = avcodec_find_encoder_by_name("h264_nvenc");
    if (!encoder || nvenc_fails || options.size.minCoeff() < least_nvenc_side) return nullptr;
    try {
        return std::make_unique<FfmpegStream>(*encoder, options);
    } catch (const FormatError&) {
        nvenc_fails = true;
        return nullptr;
    }
}

std::unique_ptr<VideoStream> open_stream(const VideoStreamOptions& options) {
    check_options(options);
    silence_ffmpeg();
    if (auto stream = open_nvenc(options)) return stream;
    const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
    if (!encoder) throw FormatError("no video can be streamed: FFmpeg has neither libx264 nor h264_nvenc");
    return std::make_unique<FfmpegStream>(*encoder, options);
}

}  // namespace
}  // namespace easypbr::io

void easypbr_ffmpeg_open_stream(const easypbr::io::VideoStreamOptions& options,
                                std::unique_ptr<easypbr::io::VideoStream>& out) {
    out = easypbr::io::open_stream(options);
}
