// A client's place in a video, whose pictures mean something only after the one before. Pure values; the
// caller tells the time.
#pragma once

#include <cstdint>

namespace easypbr::remote {

/// Where a picture stands in a video.
struct VideoMark {
    uint32_t frame = 0;  ///< its number
    uint32_t after = 0;  ///< number of the one that it needs; 0: none, a key frame
};

class VideoSeat {
  public:
    /// What the client says: that it decodes video, and has lost its place if it had one; or that it does
    /// not.
    void decodes(bool does, double now_s);
    bool can_take(const VideoMark& mark) const {
        return decodes_ && (mark.after == 0 || (frame_ != 0 && frame_ == mark.after));
    }
    void took(const VideoMark& mark, double now_s);
    /// It was too slow for a picture: it waits for a key frame, longer each time that it soon falls out
    /// again.
    void missed(double now_s);
    /// It looked away: it waits for a key frame.
    void leave() { frame_ = 0; }

    /// Whether it goes on with a picture after that one.
    bool follows(uint32_t newest) const { return decodes_ && frame_ != 0 && frame_ == newest; }
    bool is_in() const { return decodes_ && frame_ != 0; }
    bool wants_key(double now_s) const { return decodes_ && frame_ == 0 && now_s >= back_s_; }

    static constexpr double first_wait_s = 1, longest_wait_s = 32;

  private:
    bool decodes_ = false;
    uint32_t frame_ = 0;  ///< last one that it was sent; 0: it has no place
    double wait_s_ = first_wait_s, back_s_ = -1e9, came_s_ = -1e9;
};

}  // namespace easypbr::remote
