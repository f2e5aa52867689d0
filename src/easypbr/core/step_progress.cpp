#include "easypbr/core/step_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "easypbr/core/log.h"

namespace easypbr {
namespace {

thread_local StepProgress* innermost_progress = nullptr;

constexpr double progress_interval_s = 0.2;

}  // namespace

StepProgress::StepProgress(std::string what, std::string step, int count, double quiet_s)
    : what_(std::move(what)),
      step_(std::move(step)),
      count_(std::max(count, 1)),
      quiet_s_(quiet_s),
      exceptions_(std::uncaught_exceptions()),
      outer_(std::exchange(innermost_progress, this)) {}

StepProgress::~StepProgress() {
    innermost_progress = outer_;
    // What an exception gives up has not ended well: fraction 1 would say so.
    if (!is_shown_ || std::uncaught_exceptions() > exceptions_) return;
    try {
        report_progress(what_, 1);
    } catch (...) {  // There is nothing left to give up, and a destructor must not throw.
    }
}

void StepProgress::done(int steps) {
    done_ = steps;
    if (outer_)
        outer_->report(outer_->done_ + double(steps) / count_);
    else
        report(steps);
}

void StepProgress::report(double steps) {
    if (outer_) return outer_->report(outer_->done_ + steps / count_);
    const auto now = Clock::now();
    const auto since = [now](Clock::time_point then) {
        return std::chrono::duration<double>(now - then).count();
    };
    if (steps <= 0 || since(start_) < quiet_s_ || (is_shown_ && since(last_) < progress_interval_s)) return;
    last_ = now;
    is_shown_ = true;
    const long left = std::lround(since(start_) / steps * (count_ - steps));
    const int current = std::min(int(std::ceil(steps)), count_);
    report_progress(
        fmt::format("{}: {} {} of {}, {}:{:02} left", what_, step_, current, count_, left / 60, left % 60),
        std::clamp(steps / count_, 0.0, 0.999));
}

}  // namespace easypbr
