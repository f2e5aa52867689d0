// What Python may do to a call that works without its lock: interrupt it by Ctrl-C, and end while it works.
#pragma once

#include <nanobind/nanobind.h>

#include <csignal>
#include <optional>

#include "easypbr/core/interrupt.h"

namespace easypbr::python {

/// One call of the library. Made and destroyed with the GIL.
///
/// On the main thread a SIGINT ends it where Python's own handler waits for it, or that of asyncio.run(); a
/// handler of the user's is called afterwards, as for all functions that are not Python's. On every thread it
/// ends when the interpreter does.
class Job {
  public:
    Job();
    ~Job();
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;

    /// Throws what Python makes of the interruption: KeyboardInterrupt, within asyncio.run() CancelledError.
    /// Needs the GIL.
    [[noreturn]] static void raise();

    /// The part without the GIL. Neither begins nor ends, but waits for the end of the process, once the
    /// interpreter ends: Python would end the thread by force when it asks for the GIL, in the middle of the
    /// library.
    class Running {
      public:
        Running();
        ~Running();
        Running(const Running&) = delete;
        Running& operator=(const Running&) = delete;
    };

  private:
    bool watches_ = false;
    std::optional<InterruptScope> scope_;
};

/// Makes the calls that are made while it lives run to their end: an update of the window is short, and its
/// panels must be drawn whole.
class Uninterrupted {
    InterruptScope scope_{{}};
};

/// Has the main thread raise an exception once it is back in Python, for calls that must not throw. Needs the
/// GIL. On another thread the exception goes to sys.unraisablehook, with the context.
void raise_later(nanobind::python_error error, const char* context);

/// Throws what a function of Python's raised, which the library called, as the library's own exception:
/// Interrupted for KeyboardInterrupt, std::bad_alloc for MemoryError, else an Error with its text. Needs the
/// GIL.
[[noreturn]] void throw_as_own(const nanobind::python_error& error);

/// Has the interpreter end what runs on other threads before it ends itself.
void bind_jobs();

}  // namespace easypbr::python
