// How often somebody may ask: limits on the number of messages and of wrong tokens.
#pragma once

#include <algorithm>
#include <deque>

namespace easypbr::remote {

/// At most 240 messages a second, in bursts of twice as many.
class MessageRate {
  public:
    /// Returns whether one more is allowed; `cost`: what it counts as. Times are in seconds, from any
    /// beginning.
    bool take(double now_s, double cost = 1) {
        left_ = last_ < 0 ? most : std::min(most, left_ + (now_s - last_) * per_second);
        last_ = now_s;
        if (left_ < cost) return false;
        left_ -= cost;
        return true;
    }
    static constexpr double per_second = 240, most = 480;
    /// Answers to pictures: a megabyte of a still has 32.
    static constexpr double ack_cost = 0.1;

  private:
    double left_ = most, last_ = -1;
};

/// Answers to wrong tokens are late once there have been many.
class WrongTokens {
  public:
    void add(double now_s) {
        times_.push_back(now_s);
        if (times_.size() > most_a_minute) times_.pop_front();
    }
    /// Seconds that the next answer shall wait.
    double delay_s(double now_s) {
        while (!times_.empty() && now_s - times_.front() > 60) times_.pop_front();
        return times_.size() >= most_a_minute ? 1 : 0;
    }
    static constexpr size_t most_a_minute = 5;

  private:
    std::deque<double> times_;
};

}  // namespace easypbr::remote
