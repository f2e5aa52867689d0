// A viewer that threads take turns in, as Python holds it.
#pragma once

#include <unistd.h>

#include <mutex>
#include <optional>

#include "easypbr/core/error.h"
#include "easypbr/python/bindings.h"
#include "easypbr/python/convert.h"
#include "easypbr/viewer/viewer.h"

namespace easypbr::python {

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

    std::mutex mutex_;
    pid_t process_ = getpid();
    Viewer viewer_;
};

inline std::optional<Vec2i> optional_size(const nb::object& size) {
    if (size.is_none()) return std::nullopt;
    return to_size(size, "size");
}

void bind_recorder(nb::module_& module, nb::class_<SharedViewer>& viewer);

}  // namespace easypbr::python
