// The time of an animation: what passes between two frames.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace easypbr::app {

/// Frames are marked by tick(); between two of them the time stands still. In real time it is that of a
/// steady clock; with a fixed step it is the same on any machine at any speed.
class Clock {
  public:
    /// Seconds since the first frame, or since the time that was set.
    double time() const { return start_ + (step_ ? *step_ * double(steps_) : passed_); }
    /// Seconds between the last two frames; 0 at the first one, and at the first after the time or the step
    /// was set.
    double delta_time() const { return delta_; }

    /// From now on each frame comes this many seconds after the last; nothing: in real time. Time goes on
    /// from where it is. Throws ArgumentError unless the step is above 0.
    void set_fixed_step(std::optional<double> step_s);
    std::optional<double> fixed_step() const { return step_; }

    /// Throws ArgumentError when the time is not finite. `on_set` is called then.
    void set_time(double time_s);
    std::function<void()> on_set;

    /// A new frame begins; `on_tick` is called then.
    void tick();
    std::function<void()> on_tick;

  private:
    void advance();

    double start_ = 0;   ///< time when counting began
    double passed_ = 0;  ///< in real time, since then
    long steps_ = 0;     ///< of fixed length, since then
    double delta_ = 0;
    std::optional<double> step_;
    std::optional<int64_t> last_ns_;  ///< of the steady clock, in real time
};

}  // namespace easypbr::app
