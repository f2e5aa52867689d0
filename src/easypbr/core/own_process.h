// What threads of one process work on, when that process is forked.
#pragma once

#include <unistd.h>

namespace easypbr {

/// The process that made it.
class OwnProcess {
  public:
    /// False in a forked child.
    bool is_this() const { return getpid() == process_; }

  private:
    pid_t process_ = getpid();
};

/// Deletes a value in the process that made it. In a forked child, which has none of its threads, it is left
/// as it is: to destroy it would wait for them, or for locks that they held.
struct DeleteInOwnProcess {
    OwnProcess process;

    template <class T>
    void operator()(T* value) const {
        if (process.is_this()) delete value;
    }
};

}  // namespace easypbr
