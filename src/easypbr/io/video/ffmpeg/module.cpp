#include "easypbr/io/video/ffmpeg/module.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/video/encoders.h"
#include "easypbr/io/video/ffmpeg/handles.h"
#include "easypbr/io/video/ffmpeg/palette.h"
#include "easypbr/io/video/ffmpeg/planes.h"
#include "easypbr/io/video/ffmpeg/remux.h"

namespace easypbr::io {

int require_written(int code, const fs::path& path) {
    if (code >= 0) return code;
    char reason[AV_ERROR_MAX_STRING_SIZE]{};
    av_strerror(code, reason, sizeof reason);
    throw FileError(fmt::format("cannot write {}: {}", path.string(), reason));
}

namespace {

/// Encoders for pictures that a file of this kind may hold.
std::vector<std::string> encoders_for(const char* container) {
    const AVOutputFormat* format = av_guess_format(container, nullptr, nullptr);
    std::vector<std::string> names;
    void* state = nullptr;
    while (const AVCodec* codec = av_codec_iterate(&state))
        if (av_codec_is_encoder(codec) && codec->type == AVMEDIA_TYPE_VIDEO &&
            (!format || avformat_query_codec(format, codec->id, FF_COMPLIANCE_NORMAL) == 1))
            names.emplace_back(codec->name);
    std::ranges::sort(names);
    return names;
}

const AVCodec& encoder_for(const fs::path& path, const std::string& wanted) {
    const std::vector<std::string> there = encoders_for(container_of(path).name);
    return *avcodec_find_encoder_by_name(choose_encoder(path, wanted, there).c_str());
}

/// The kinds of pictures that an encoder takes, ended by AV_PIX_FMT_NONE; null: it does not say.
const AVPixelFormat* formats_of(const AVCodec& encoder) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(61, 13, 100)
    const void* formats = nullptr;
    avcodec_get_supported_config(nullptr, &encoder, AV_CODEC_CONFIG_PIX_FORMAT, 0, &formats, nullptr);
    return static_cast<const AVPixelFormat*>(formats);
#else
    return encoder.pix_fmts;
#endif
}

/// What the encoder takes of the pictures' kinds that we can make: its own first choice among them.
AVPixelFormat pixel_format_of(const AVCodec& encoder) {
    constexpr AVPixelFormat known[] = {AV_PIX_FMT_YUV420P, AV_PIX_FMT_PAL8,  AV_PIX_FMT_YUVJ420P,
                                       AV_PIX_FMT_YUV444P, AV_PIX_FMT_RGB24, AV_PIX_FMT_RGBA,
                                       AV_PIX_FMT_BGR0,    AV_PIX_FMT_RGB8};
    const AVPixelFormat* all = formats_of(encoder);
    if (!all) return AV_PIX_FMT_YUV420P;
    for (const AVPixelFormat format : known)
        for (const AVPixelFormat* taken = all; *taken != AV_PIX_FMT_NONE; ++taken)
            if (*taken == format) return format;
    throw ArgumentError(fmt::format(
        "the encoder {} takes none of the kinds of pictures that can be made for it", encoder.name));
}

class FfmpegVideo final : public VideoWriter {
  public:
    FfmpegVideo(VideoFile file, const VideoOptions& options)
        : file_(std::move(file)), path_(file_.name()), size_(options.size) {
        check_video_options(path_, options);
        silence_ffmpeg();
        const AVCodec& encoder = encoder_for(path_, options.codec);
        AVFormatContext* raw = nullptr;
        require_written(
            avformat_alloc_output_context2(&raw, nullptr, container_of(path_).name, file_.path().c_str()),
            path_);
        output_.reset(raw);
        open_encoder(encoder, options.fps);
        make_frame();
        begin_file();
    }

    ~FfmpegVideo() override {
        if (finished_) return;
        try {
            finish();
        } catch (const Error& error) {
            log_warning(error.what());
        }
    }

    void add(const Image& picture) override {
        check_video_picture(path_, size_, picture);
        require_written(av_frame_make_writable(frame_.get()), path_);
        if (codec_->pix_fmt == AV_PIX_FMT_PAL8)
            fill_palette(picture);
        else
            planes_->fill(picture, *frame_);
        frame_->pts = next_++;
        whole_or_none([&] { encode(frame_.get()); });
    }

    void finish() override {
        if (finished_) return;
        finished_ = true;
        if (next_ == 0) return remove();
        whole_or_none([&] {
            encode(nullptr);
            require_written(av_write_trailer(output_.get()), path_);
            require_written(output_->pb->error, path_);
            require_written(avio_closep(&output_->pb), path_);
            file_.keep();
        });
        if (!is_fragmented()) return;
        try {
            index_first(file_.path());
        } catch (const std::exception& error) {
            log_warning(fmt::format("{} stays a fragmented MP4: {}", path_.string(), error.what()));
        }
    }

  private:
    /// A video that cannot be written to its end is removed: nothing tells half of one from a whole one.
    template <class Write>
    void whole_or_none(Write&& write) {
        try {
            write();
        } catch (...) {
            finished_ = true;
            remove();
            throw;
        }
    }

    void remove() {
        output_.reset();
        file_.remove();
    }

    bool is_fragmented() const {
        const std::string name = output_->oformat->name;
        return name == "mp4" || name == "mov";
    }

    void describe(const AVCodec& encoder, double fps) {
        AVCodecContext& codec = *codec_;
        describe_pictures(codec, pixel_format_of(encoder), size_);
        codec.framerate = av_d2q(fps, 100000);
        codec.time_base = av_inv_q(codec.framerate);
        codec.gop_size = std::max(1, int(std::lround(fps)));
        codec.max_b_frames = 0;  // Nothing of what was written waits for a frame to come.
        if (output_->oformat->flags & AVFMT_GLOBALHEADER) codec.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    }

    /// The error code. 0 threads: as many as the encoder likes.
    int try_encoder(const AVCodec& encoder, double fps, int threads) {
        codec_.reset(avcodec_alloc_context3(&encoder));
        describe(encoder, fps);
        codec_->thread_count = threads;
        AVDictionary* options = nullptr;
        const std::string name = encoder.name;
        const auto wanted = encoder_options(name);
        for (const auto& [option, value] : wanted) av_dict_set(&options, option.c_str(), value.c_str(), 0);
        if (wanted.empty() && name != "gif") {
            codec_->flags |= AV_CODEC_FLAG_QSCALE;
            codec_->global_quality = fixed_quantiser * FF_QP2LAMBDA;
        }
        const int opened = avcodec_open2(codec_.get(), &encoder, &options);
        av_dict_free(&options);
        return opened;
    }

    /// Encoders do not say that the system gave them no threads: they may do with the caller's.
    void open_encoder(const AVCodec& encoder, double fps) {
        int opened = try_encoder(encoder, fps, 0);
        if (opened < 0) opened = try_encoder(encoder, fps, 1);
        if (opened == AVERROR(EAGAIN) || opened == AVERROR(ENOMEM)) require_written(opened, path_);
        if (opened < 0)
            throw ArgumentError(
                fmt::format("cannot write {}: the encoder {} does not take pictures of {}x{} at this "
                            "rate",
                            path_.string(), encoder.name, codec_->width, codec_->height));
    }

    void make_frame() {
        frame_ = frame_for(*codec_);
        require_written(frame_ ? 0 : AVERROR(ENOMEM), path_);
        packet_.reset(av_packet_alloc());
        if (codec_->pix_fmt != AV_PIX_FMT_PAL8)
            planes_.emplace(*codec_, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP);
    }

    void begin_file() {
        stream_ = avformat_new_stream(output_.get(), nullptr);
        require_written(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), path_);
        stream_->time_base = codec_->time_base;
        stream_->avg_frame_rate = codec_->framerate;
        require_written(avio_open(&output_->pb, file_.path().c_str(), AVIO_FLAG_WRITE), path_);
        output_->flags |= AVFMT_FLAG_FLUSH_PACKETS;
        AVDictionary* options = nullptr;
        if (is_fragmented())
            av_dict_set(&options, "movflags", "+empty_moov+default_base_moof+frag_every_frame", 0);
        const int begun = avformat_write_header(output_.get(), &options);
        av_dict_free(&options);
        require_written(begun, path_);
    }

    void encode(AVFrame* frame) {
        require_written(avcodec_send_frame(codec_.get(), frame), path_);
        for (;;) {
            const int received = avcodec_receive_packet(codec_.get(), packet_.get());
            if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return;
            require_written(received, path_);
            packet_->duration = 1;
            av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
            packet_->stream_index = stream_->index;
            require_written(av_interleaved_write_frame(output_.get(), packet_.get()), path_);
            require_written(output_->pb->error, path_);
        }
    }

    void fill_palette(const Image& picture) {
        const Palette palette = median_cut(picture);
        map_to_palette(picture, palette, frame_->data[0], frame_->linesize[0]);
        std::ranges::copy(palette, reinterpret_cast<uint32_t*>(frame_->data[1]));
    }

    VideoFile file_;
    fs::path path_;  ///< the file's name in messages
    Vec2i size_;
    Output output_;
    Codec codec_;
    FrameHandle frame_;
    Packet packet_;
    std::optional<ToPlanes> planes_;
    AVStream* stream_ = nullptr;
    int64_t next_ = 0;
    bool finished_ = false;
};

}  // namespace
}  // namespace easypbr::io

using namespace easypbr;

void easypbr_ffmpeg_open(io::VideoFile&& file, const io::VideoOptions& options,
                         std::unique_ptr<io::VideoWriter>& out) {
    out = std::make_unique<io::FfmpegVideo>(std::move(file), options);
}

void easypbr_ffmpeg_check(const std::filesystem::path& path, const std::string& codec) {
    io::encoder_for(path, codec);
}

void easypbr_ffmpeg_encoders(std::vector<std::string>& out) {
    out = io::encoders_for("matroska");
}
