// A viewer that threads take turns in, as Python holds it.
#pragma once

#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <optional>

#include "easypbr/core/error.h"
#include "easypbr/python/bindings.h"
#include "easypbr/python/convert.h"
#include "easypbr/viewer/viewer.h"

namespace easypbr::python {

/// Lets threads in by the order in which they came: a loop that updates a window leaves others their turn.
class Turns {
  public:
    void lock() {
        std::unique_lock lock(mutex_);
        const uint64_t turn = next_++;
        changed_.wait(lock, [&] { return turn == served_; });
    }
    void unlock() {
        {
            const std::lock_guard lock(mutex_);
            ++served_;
        }
        changed_.notify_all();
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    uint64_t next_ = 0, served_ = 0;
};

/// A viewer that threads take turns in.
class SharedViewer {
  public:
    explicit SharedViewer(const Scene& scene) : viewer_(scene) {}

    template <class Work>
    auto run(Work&& work) {
        return released([&] {
            require_same_process();
            const std::lock_guard lock(mutex_);
            return work(viewer_);
        });
    }

  private:
    void require_same_process() const {
        if (getpid() != process_)
            throw ContextError(
                "this viewer belongs to the process that this one was forked from: GL contexts do not "
                "survive a fork; "
                "start processes with multiprocessing.get_context('spawn')");
    }

    Turns mutex_;
    pid_t process_ = getpid();
    Viewer viewer_;
};

inline std::optional<Vec2i> optional_size(const nb::object& size) {
    if (size.is_none()) return std::nullopt;
    return to_size(size, "size");
}

void bind_recorder(nb::module_& module, nb::class_<SharedViewer>& viewer);

}  // namespace easypbr::python
