#include "easypbr/app/clock.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "easypbr/core/error.h"

namespace easypbr::app {

void Clock::set_fixed_step(std::optional<double> step_s) {
    if (step_s && !(*step_s > 0 && std::isfinite(*step_s)))
        throw ArgumentError(fmt::format("fixed time step: expected above 0 seconds, got {}", *step_s));
    set_time(time());
    step_ = step_s;
}

void Clock::set_time(double time_s) {
    if (!std::isfinite(time_s))
        throw ArgumentError(fmt::format("time: expected finite seconds, got {}", time_s));
    start_ = time_s;
    passed_ = 0;
    steps_ = 0;
    delta_ = 0;
    last_ns_.reset();
    if (on_set) on_set();
}

void Clock::tick() {
    advance();
    if (on_tick) on_tick();
}

void Clock::advance() {
    if (step_) {
        // Counted, not added up: the thousandth frame comes after a thousand steps to the last bit.
        ++steps_;
        delta_ = *step_;
        return;
    }
    const auto passed = std::chrono::steady_clock::now().time_since_epoch();
    const int64_t now_ns = std::chrono::nanoseconds(passed).count();
    delta_ = last_ns_ ? double(now_ns - *last_ns_) * 1e-9 : 0;
    passed_ += delta_;
    last_ns_ = now_ns;
}

}  // namespace easypbr::app
