#include "easypbr/app/clock.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "easypbr/core/error.h"

namespace easypbr::app {
namespace {

int64_t steady_ns() {
    const auto passed = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::nanoseconds(passed).count();
}

}  // namespace

void Clock::set_fixed_step(std::optional<double> step_s) {
    if (step_s && !(*step_s > 0 && std::isfinite(*step_s)))
        throw ArgumentError(fmt::format("fixed time step: expected above 0 seconds, got {}", *step_s));
    const bool goes_on = step_s.has_value() == step_.has_value();
    count_from(time(), goes_on ? now_.tick_ns : std::nullopt);
    step_ = step_s;
}

void Clock::set_time(double time_s) {
    if (!std::isfinite(time_s))
        throw ArgumentError(fmt::format("time: expected finite seconds, got {}", time_s));
    count_from(time_s, std::nullopt);
    if (on_set) on_set();
}

void Clock::count_from(double time_s, std::optional<int64_t> tick_ns) {
    start_ = time_s;
    now_ = before_ = {.tick_ns = tick_ns};
}

void Clock::tick() {
    before_ = now_;
    advance();
    if (on_tick) on_tick();
}

void Clock::end_frame() {
    if (!now_.tick_ns) now_.tick_ns = steady_ns();
    tick();
}

void Clock::take_back() {
    now_ = before_;
    if (on_tick) on_tick();
}

void Clock::advance() {
    const int64_t tick_ns = steady_ns();
    const std::optional<int64_t> last_ns = std::exchange(now_.tick_ns, tick_ns);
    now_.delta = 0;
    if (!last_ns) return;
    // Counted, not added up: the thousandth frame comes after a thousand steps to the last bit.
    now_.steps += 1;
    now_.delta = step_ ? *step_ : double(tick_ns - *last_ns) * 1e-9;
    now_.passed += now_.delta;
}

}  // namespace easypbr::app
