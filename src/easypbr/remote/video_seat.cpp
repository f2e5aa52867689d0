#include "easypbr/remote/video_seat.h"

#include <algorithm>

namespace easypbr::remote {

void VideoSeat::decodes(bool does, double now_s) {
    if (does && is_in()) missed(now_s);
    decodes_ = does;
}

void VideoSeat::took(const VideoMark& mark, double now_s) {
    if (frame_ == 0) came_s_ = now_s;
    frame_ = mark.frame;
}

void VideoSeat::missed(double now_s) {
    if (frame_ == 0) return;
    // Who has kept up for longer than it had to wait begins with a short wait again.
    if (now_s - came_s_ > 2 * wait_s_) wait_s_ = first_wait_s;
    back_s_ = now_s + wait_s_;
    wait_s_ = std::min(longest_wait_s, 2 * wait_s_);
    frame_ = 0;
}

}  // namespace easypbr::remote
