#include "easypbr/remote/moving_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/stopwatch.h"

namespace easypbr::remote {
namespace {

/// What the encoder counts its rate by; the pictures come as they are drawn.
constexpr double nominal_fps = 30;
constexpr double least_interval_s = 1.0 / 120, most_interval_s = 1.0 / 8;
/// Changes of the rate that are worth asking the encoder for.
constexpr double rate_step = 0.08;
/// Smaller pictures are no video: a page that is not laid out yet asks for one pixel.
constexpr int least_video_side = 16;

bool is_large_enough(const Image& image) {
    return std::min(image.width(), image.height()) >= least_video_side;
}

}  // namespace

std::string video_refusal() {
    try {
        io::open_video_stream({.size = {64, 64}});
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

void MovingPictures::code(EncodeJob job) {
    const VideoDemand demand = clients_.demand();
    MovingPicture picture;
    if (demand.video && is_large_enough(job.image)) picture.video = coded(job, demand.key);
    if (demand.jpeg || !picture.video) {
        job.header.codec = Codec::jpeg;
        picture.jpeg = encode(std::move(job));
    }
    const std::optional<VideoMark> mark = picture.video ? std::optional(picture.video->mark) : std::nullopt;
    // One that came too late is in nobody's video: the next one begins it again.
    if (!clients_.publish(std::move(picture)))
        stream_.reset();
    else if (mark)
        last_ = mark->frame;
}

std::optional<MovingPicture::Video> MovingPictures::coded(const EncodeJob& job, bool as_key) {
    try {
        double seconds = 0;
        MovingPicture::Video video;
        video.picture.header = job.header;
        FrameHeader& header = video.picture.header;
        {
            const Stopwatch watch(seconds);
            open_for(job);
            follow_rate(job);
            io::CodedPicture coded = stream_->add(job.image, as_key);
            video.mark = {header.frame, coded.is_key ? 0 : last_};
            header.flags |= coded.is_key ? FrameHeader::key : 0;
            video.picture.bytes = std::make_shared<const std::vector<std::byte>>(std::move(coded.bytes));
        }
        describe(header, job.image, *video.picture.bytes, seconds);
        header.codec = Codec::h264;
        return video;
    } catch (const Error& error) {
        log_warning(std::string("moving pictures are sent as JPEG from now on: ") + error.what());
        clients_.offer_video(false);
        stream_.reset();
        return std::nullopt;
    }
}

void MovingPictures::open_for(const EncodeJob& job) {
    const Vec2i size(job.image.width(), job.image.height());
    if (stream_ && size == size_) return;
    const bool is_first = size_ == Vec2i(0, 0);
    rate_ = job.rate;
    stream_ = io::open_video_stream({.size = size, .fps = nominal_fps, .rate = rate_});
    size_ = size;
    if (is_first) log(LogLevel::info, "moving pictures are sent as H.264 by " + stream_->encoder());
}

/// Pictures that come more slowly than the encoder counts may have more bits each, and the other way round.
void MovingPictures::follow_rate(const EncodeJob& job) {
    const double now = now_seconds();
    const double since = std::exchange(coded_s_, now);
    if (now - since < 1) {
        const double interval = std::clamp(now - since, least_interval_s, most_interval_s);
        interval_s_ = 0.9 * interval_s_ + 0.1 * interval;
    }
    const double rate = job.rate * std::min(2.0, interval_s_ * nominal_fps);
    if (std::abs(rate - rate_) < rate_step * rate_) return;
    stream_->set_rate(rate);
    rate_ = rate;
}

}  // namespace easypbr::remote
