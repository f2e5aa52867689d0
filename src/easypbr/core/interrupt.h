// How a long job is given up: it asks between its steps whether it is to go on.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>

namespace easypbr {

/// The job was given up because an InterruptScope said so. Not an Error: nothing is wrong with what was asked
/// for.
class Interrupted : public std::exception {
  public:
    const char* what() const noexcept override { return "interrupted"; }
};

/// Makes the jobs that this thread runs stop once `stop` returns true, for as long as the object lives. It is
/// called often, so it must be quick, and must not throw. An empty function: they run to their end. Scopes
/// nest; the innermost counts, and with `also_outer` those around it too.
class InterruptScope {
  public:
    explicit InterruptScope(std::function<bool()> stop, bool also_outer = false);
    ~InterruptScope();
    InterruptScope(const InterruptScope&) = delete;
    InterruptScope& operator=(const InterruptScope&) = delete;

    bool is_stopped() const { return (stop_ && stop_()) || (also_outer_ && outer_ && outer_->is_stopped()); }

  private:
    std::function<bool()> stop_;
    bool also_outer_;
    const InterruptScope* outer_;
};

/// Throws Interrupted when the thread's InterruptScope says so. Parallel loops, samples, tiles and waits for
/// the driver call it.
void check_interrupt();

/// The same at some steps of a loop whose steps are short.
inline void check_interrupt(size_t step) {
    if (step % (size_t(1) << 16) == 0) check_interrupt();
}

/// Whether anybody may interrupt this thread.
bool can_be_interrupted();

}  // namespace easypbr
