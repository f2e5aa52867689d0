// How much a client is sent: by what it says that it has drawn. Pure values; the caller tells the time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace easypbr::remote {

/// Seconds of an answer that the line did not take.
struct OffTheLine {
    double page_s = 0;    ///< the client, from the picture's arrival to its being drawn
    double server_s = 0;  ///< the server's thread, which had other work before it wrote and before it read
};

/// Pictures on their way to a client. Times are in seconds, from any beginning.
class FlowControl {
  public:
    void sent(uint32_t frame, uint32_t chunk, size_t bytes, double now_s);
    /// The client has drawn it, and with it all that was sent before. What was not sent is ignored.
    void drawn(uint32_t frame, uint32_t chunk, double now_s, const OffTheLine& off = {});

    /// Another picture may be sent, beside so many that will be: the line does not run dry, and no more.
    bool has_room(size_t coming = 0) const {
        return count() + coming < window() && (count() == 0 || bytes_ < most_bytes);
    }
    /// Another chunk of a still may: fewer on a line that queues, so that a picture can overtake the rest.
    bool has_chunk_room() const { return count() < chunks_; }
    size_t count() const { return on_way_.size(); }
    /// Seconds since the oldest picture on its way was sent; 0: there is none.
    double waits_s(double now_s) const { return on_way_.empty() ? 0 : now_s - on_way_.front().sent_s; }

    /// From sending to the answer that it is drawn, of the last one; 0 before.
    double latency_s() const { return latency_; }
    /// The shortest of the last 10 s.
    double least_latency_s() const;
    /// How much longer than that the last one took, without what was not the line's: pictures wait there.
    double queued_s() const { return queued_; }
    /// As many as were sent in the shortest time, and one: it grows for as long as more get through.
    size_t window() const;

    static constexpr size_t least_window = 2, most_window = 8, most_chunks = 16;
    static constexpr size_t most_bytes = size_t(1) << 20;
    /// What a line that does not queue may take longer than its best time.
    static constexpr double queue_s = 0.05;

  private:
    struct Sent {
        uint32_t frame, chunk;
        size_t bytes;
        double sent_s;
    };
    void measure(double latency_s, double now_s);

    std::deque<Sent> on_way_;
    size_t bytes_ = 0, chunks_ = 4;
    double latency_ = 0, queued_ = 0, interval_ = 1.0 / 30, last_sent_ = -1;
    double least_now_ = 0, least_before_ = 0,
           epoch_ = -1;  ///< shortest of this half of the 10 s, and of the last
};

/// How good moving pictures are, by how long they wait on the line to a client: the quality of a JPEG or the
/// bit rate of a video goes first, then the resolution.
class WireQuality {
  public:
    /// Which of both the client is sent.
    void use_video(bool video) { video_ = video; }
    /// To be told about every picture that was drawn.
    void drawn(double queued_s, double now_s);

    int jpeg_quality() const;
    /// Bits per second at most of a video whose pictures have that size at the best resolution.
    double video_rate(double pixels) const;
    /// Share of the resolution, 0.25 to 1.
    double resolution() const;
    double share() const { return share_; }

    static constexpr double least_share = 1.0 / 32;
    /// 4 Mbit/s at 1280x720.
    static constexpr double bits_per_pixel_second = 4e6 / (1280 * 720);
    static constexpr double least_rate = 2e5, most_rate = 2e7;

  private:
    bool video_ = false;
    double share_ = 1;  ///< of the bytes that the best picture has
    double decided_ = -1;
    double late_s_ = 0;  ///< all pictures since it was decided together
    int pictures_ = 0;
};

}  // namespace easypbr::remote
