// How far work of equal steps is, with the time that is left.
#pragma once

#include <chrono>
#include <string>

namespace easypbr {

/// Reports progress (core/log.h) from some seconds after its construction on, a few times per second, and its
/// end when it goes out of scope, unless an exception passes. What runs inside another one on the same
/// thread, such as the samples of a frame of a recording, is a part of that one's step.
class StepProgress {
  public:
    /// `what` is done, in `count` steps (above 0) that are called `step`: "turn.mp4: frame 3 of 10, 0:12
    /// left".
    StepProgress(std::string what, std::string step, int count, double quiet_s = 2);
    ~StepProgress();
    StepProgress(const StepProgress&) = delete;
    StepProgress& operator=(const StepProgress&) = delete;

    /// So many steps are done, 0 to count.
    void done(int steps);

  private:
    using Clock = std::chrono::steady_clock;

    void report(double steps);

    std::string what_, step_;
    int count_;
    double quiet_s_;
    int done_ = 0;
    bool is_shown_ = false;
    int exceptions_;  ///< that were passing at its construction
    StepProgress* outer_;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace easypbr
