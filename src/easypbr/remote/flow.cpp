#include "easypbr/remote/flow.h"

#include <algorithm>
#include <cmath>

namespace easypbr::remote {
namespace {

constexpr double memory_s = 10;
constexpr double decide_s = 0.5;
constexpr double quick_s = 0.02;  ///< of waiting: the line has room
constexpr int best_quality = 80, worst_quality = 40;
/// Of the bytes: what lowering the quality saves, before the resolution has to go down.
constexpr double quality_share = 0.4, video_share = 0.125;

}  // namespace

void FlowControl::sent(uint32_t frame, uint32_t chunk, size_t bytes, double now_s) {
    if (chunk == 0 && last_sent_ >= 0)
        interval_ = 0.8 * interval_ + 0.2 * std::clamp(now_s - last_sent_, 0.005, 0.2);
    if (chunk == 0) last_sent_ = now_s;
    on_way_.push_back({frame, chunk, bytes, now_s});
    bytes_ += bytes;
}

void FlowControl::drawn(uint32_t frame, uint32_t chunk, double now_s, const OffTheLine& off) {
    const auto found = std::ranges::find_if(
        on_way_, [&](const Sent& sent) { return sent.frame == frame && sent.chunk == chunk; });
    if (found == on_way_.end()) return;
    measure(now_s - found->sent_s, now_s);
    queued_ = std::max(0.0, latency_ - off.page_s - off.server_s - least_latency_s());
    for (auto sent = on_way_.begin(); sent != found + 1; ++sent) bytes_ -= sent->bytes;
    on_way_.erase(on_way_.begin(), found + 1);
    chunks_ = queued_ > queue_s ? std::max<size_t>(1, chunks_ / 2) : std::min(most_chunks, chunks_ + 1);
}

void FlowControl::measure(double latency_s, double now_s) {
    latency_ = std::max(latency_s, 1e-6);
    if (epoch_ < 0 || now_s - epoch_ > memory_s / 2) {
        least_before_ = epoch_ < 0 ? latency_ : least_now_;
        least_now_ = latency_;
        epoch_ = now_s;
    }
    least_now_ = std::min(least_now_, latency_);
}

double FlowControl::least_latency_s() const {
    return std::min(least_now_, least_before_);
}

size_t FlowControl::window() const {
    const double frames = std::ceil(least_latency_s() / interval_) + 1;
    return std::clamp(size_t(frames), least_window, most_window);
}

void WireQuality::drawn(double queued_s, double now_s) {
    late_s_ += queued_s;
    ++pictures_;
    if (decided_ < 0) decided_ = now_s;
    if (now_s - decided_ < decide_s) return;
    // The mean: a line that queues delays all of them, a page that is busy for a moment one.
    const double late = late_s_ / pictures_;
    if (late > FlowControl::queue_s) share_ = std::max(least_share, share_ * 0.8);
    if (late < quick_s) share_ = std::min(1.0, share_ * 1.1);
    decided_ = now_s;
    late_s_ = 0;
    pictures_ = 0;
}

int WireQuality::jpeg_quality() const {
    const double lost = std::clamp((1 - share_) / (1 - quality_share), 0.0, 1.0);
    return int(std::lround(best_quality - lost * (best_quality - worst_quality)));
}

double WireQuality::video_rate(double pixels) const {
    return std::max(least_rate, share_ * std::min(most_rate, pixels * bits_per_pixel_second));
}

double WireQuality::resolution() const {
    return std::clamp(std::sqrt(share_ / (video_ ? video_share : quality_share)), 0.25, 1.0);
}

}  // namespace easypbr::remote
