// The log sink: the library never prints; it hands every message to one function of the caller's.
#pragma once

#include <functional>
#include <string_view>

namespace easypbr {

enum class LogLevel { debug, info, warning };

using LogSink = std::function<void(LogLevel, std::string_view)>;

/// Replaces the sink (process-wide); an empty function silences the log, which is the default. Thread-safe.
/// Sinks are kept until the process ends: the destructors of static objects may log.
void set_log_sink(LogSink sink);

/// Sends one message (without line end) to the sink. Thread-safe.
void log(LogLevel level, std::string_view message);

inline void log_warning(std::string_view message) {
    log(LogLevel::warning, message);
}

/// Progress of a long operation: what is being done and the part done in [0, 1].
using ProgressSink = std::function<void(std::string_view what, double fraction)>;

/// Replaces the progress sink (process-wide); called from one thread at a time, a few times per second at
/// most. What it throws ends the operation and passes to its caller, so that it can be cancelled; no call
/// with fraction 1 follows then. What a call with fraction 1 throws may be ignored, as the work is done.
void set_progress_sink(ProgressSink sink);

/// Reports progress to the sink, if there is one.
void report_progress(std::string_view what, double fraction);

}  // namespace easypbr
