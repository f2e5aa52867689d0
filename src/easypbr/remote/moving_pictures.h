// MovingPictures: what is sent while something moves, a video for those who decode it and JPEGs for others.
#pragma once

#include <memory>

#include "easypbr/io/video/video_stream.h"
#include "easypbr/remote/encoder.h"
#include "easypbr/remote/view_clients.h"

namespace easypbr::remote {

/// Used by one thread.
class MovingPictures {
  public:
    explicit MovingPictures(ViewClients clients) : clients_(clients) {}

    /// Codes a picture as the clients need it, and publishes it.
    void code(EncodeJob job);

  private:
    /// Empty when the encoder does not work: then JPEGs are for all.
    std::optional<MovingPicture::Video> coded(const EncodeJob& job, bool as_key);
    void open_for(const EncodeJob& job);
    void follow_rate(const EncodeJob& job);

    ViewClients clients_;
    std::unique_ptr<io::VideoStream> stream_;
    Vec2i size_{0, 0};
    uint32_t last_ = 0;  ///< number of the last picture of the stream that was published; 0: none
    double interval_s_ = 1.0 / 30, coded_s_ = -1e9, rate_ = 0;
};

/// Why no video can be streamed here; empty: it can.
std::string video_refusal();

}  // namespace easypbr::remote
