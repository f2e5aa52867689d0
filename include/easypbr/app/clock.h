// The time of an animation: what passes between two frames.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace easypbr::app {

/// Frames are marked by tick(); between two of them the time stands still. In real time it is that of a
/// steady clock; with a fixed step it is the same on any machine at any speed. The first frame is at 0, or at
/// the time that was set; it is also the first after a change between real time and fixed steps.
class Clock {
  public:
    /// Seconds since the first frame, or since the time that was set.
    double time() const { return start_ + (step_ ? *step_ * double(now_.steps) : now_.passed); }
    /// Seconds between the last two frames; 0 at the first one.
    double delta_time() const { return now_.delta; }

    /// From now on each frame comes this many seconds after the last; nothing: in real time. Time goes on
    /// from where it is. Throws ArgumentError unless the step is above 0.
    void set_fixed_step(std::optional<double> step_s);
    std::optional<double> fixed_step() const { return step_; }

    /// Throws ArgumentError when the time is not finite. `on_set` is called then.
    void set_time(double time_s);
    std::function<void()> on_set;

    /// A new frame begins; `on_tick` is called then.
    void tick();
    /// The frame at time(), also a first one that no tick() began, is over: the next one begins.
    void end_frame();
    /// The frame that the last tick() began was not drawn: the time is that before it. `on_tick` is called
    /// then.
    void take_back();
    std::function<void()> on_tick;

  private:
    struct Frame {
        double passed = 0;  ///< in real time, since counting began
        long steps = 0;     ///< of fixed length, since then
        double delta = 0;
        std::optional<int64_t> tick_ns;  ///< of the steady clock; nothing: the first frame is yet to come
    };
    void count_from(double time_s, std::optional<int64_t> tick_ns);
    void advance();

    double start_ = 0;  ///< time when counting began
    std::optional<double> step_;
    Frame now_, before_;
};

}  // namespace easypbr::app
