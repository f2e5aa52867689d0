#include "easypbr/core/log.h"

#include <mutex>
#include <utility>

namespace easypbr {
namespace {

template <class Sink>
struct Slot {
    std::mutex mutex;
    Sink sink;

    void replace(Sink next) {
        std::lock_guard lock(mutex);
        sink = std::move(next);
    }

    /// Calls a copy of the sink with no lock held, so that a sink may log or replace itself.
    template <class... Arguments>
    void call(Arguments&&... arguments) {
        Sink copy;
        {
            std::lock_guard lock(mutex);
            copy = sink;
        }
        if (copy) copy(std::forward<Arguments>(arguments)...);
    }
};

// Never destroyed: static objects of a program, such as a viewer, may log when they are.
Slot<LogSink>& log_slot() {
    static auto* const slot = new Slot<LogSink>;
    return *slot;
}

Slot<ProgressSink>& progress_slot() {
    static auto* const slot = new Slot<ProgressSink>;
    return *slot;
}

}  // namespace

void set_log_sink(LogSink sink) {
    log_slot().replace(std::move(sink));
}

void log(LogLevel level, std::string_view message) {
    log_slot().call(level, message);
}

void set_progress_sink(ProgressSink sink) {
    progress_slot().replace(std::move(sink));
}

void report_progress(std::string_view what, double fraction) {
    progress_slot().call(what, fraction);
}

}  // namespace easypbr
