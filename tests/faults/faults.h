// Faults of the system on purpose: this program stands between the library and libc. One fault at a time, for
// all threads.
#pragma once

#include <string>

namespace easypbr::faults {

enum class Kind {
    none,
    allocation,        ///< the n-th one gives nothing
    large_allocation,  ///< the n-th of 8 KiB or more gives nothing
    short_reads,       ///< reading and writing take a few bytes at a time
    interruptions,     ///< every second call that may be interrupted is
    open,              ///< the n-th file cannot be opened: EACCES
    read,              ///< the n-th read fails: EIO
    write,             ///< the n-th write fails, and all after it: ENOSPC; the n-th takes half of its bytes
    thread,            ///< the n-th thread cannot be started, and none after it: EAGAIN
    rename,            ///< the n-th file cannot be moved to its place: EACCES
    clock              ///< the time of day jumps by years between any two looks at it
};

/// While it lives, calls are counted and the n-th of its kind fails; 0: none does, they are counted alone.
class Fault {
  public:
    explicit Fault(Kind kind, long n = 0);
    ~Fault();
    Fault(const Fault&) = delete;

    /// Calls of the kind since the beginning.
    static long calls();
    /// Whether the fault has happened.
    static bool happened();
    /// Says in the words of a crash which fault it came by.
    static void name(const std::string& job);
};

}  // namespace easypbr::faults
