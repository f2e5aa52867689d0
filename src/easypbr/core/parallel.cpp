#include "easypbr/core/parallel.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "easypbr/core/control_group.h"
#include "easypbr/core/error.h"
#include "easypbr/core/folder.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/core/opened_files.h"
#include "easypbr/core/variable.h"

#ifdef EASYPBR_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace easypbr {
namespace {

#ifdef EASYPBR_THREAD_SANITIZER
constexpr bool sees_threads_of_tbb = false;
#else
constexpr bool sees_threads_of_tbb = true;
#endif

/// TBB, which is not built with ThreadSanitizer, hands chunks to its threads and back: says so to it. The
/// same for all loops, so that a thread need not read which one it is in.
struct HandOver {
    static void give() {
#ifdef EASYPBR_THREAD_SANITIZER
        __tsan_release(&place_);
#endif
    }
    static void take() {
#ifdef EASYPBR_THREAD_SANITIZER
        __tsan_acquire(&place_);
#endif
    }

  private:
    [[maybe_unused]] static inline char place_ = 0;
};

/// A chunk's time on its thread, ended by an exception too.
struct OnThread {
    OnThread() { HandOver::take(); }
    ~OnThread() { HandOver::give(); }
    OnThread(const OnThread&) = delete;
    OnThread& operator=(const OnThread&) = delete;
};

/// The time of a loop as its caller sees it.
struct InLoop {
    InLoop() { HandOver::give(); }
    ~InLoop() { HandOver::take(); }
    InLoop(const InLoop&) = delete;
    InLoop& operator=(const InLoop&) = delete;
};

/// What EASYPBR_THREADS says.
std::optional<size_t> wanted_threads() {
    const std::optional<std::string> given = variable("EASYPBR_THREADS");
    if (!given) return std::nullopt;
    const int count = whole_number(*given).value_or(0);
    if (count < 1)
        throw ArgumentError(
            fmt::format("EASYPBR_THREADS: expected a whole number of 1 or more, got '{}'", *given));
    return size_t(count);
}

/// EASYPBR_THREADS keeps the loops to as many threads; else the quota of control groups does, beyond which
/// threads would wait for each other's turns. Throws ArgumentError, each time, for a wrong one.
void limit_threads() {
    using Limit = tbb::global_control;
    static const std::unique_ptr<Limit> limit = []() -> std::unique_ptr<Limit> {
        const std::optional<size_t> wanted = wanted_threads();
        const int granted = threads_in_groups();
        if (!wanted && granted >= tbb::info::default_concurrency()) return nullptr;
        return std::make_unique<Limit>(Limit::max_allowed_parallelism, wanted.value_or(size_t(granted)));
    }();
}

/// The thread pool stays behind in the parent when a process is forked: the child works alone.
bool has_threads() {
    static const pid_t owner = getpid();
    return owner == getpid();
}

}  // namespace

void parallel_chunks(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    grain = std::max<size_t>(grain, 1);
    const size_t chunks = (count + grain - 1) / grain;
    if (chunks <= 1) {
        if (count) body(0, count);
        return;
    }
    const auto run = [&, folder = FolderScope::current(),
                      opened = OpenedFilesScope::current()](size_t chunk) {
        const OnThread here;
        const FolderScope beneath(folder);
        const OpenedFilesScope noted(opened);
        check_interrupt();
        body(chunk * grain, std::min(count, (chunk + 1) * grain));
    };
    if (!has_threads()) {
        for (size_t chunk = 0; chunk < chunks; ++chunk) run(chunk);
        return;
    }
    limit_threads();
    const InLoop loop;
    tbb::parallel_for(size_t(0), chunks, run);
}

void parallel_sort(std::vector<KeyedIndex>& items) {
    const auto before = [](const KeyedIndex& a, const KeyedIndex& b) {
        return a.key < b.key || (a.key == b.key && a.index < b.index);
    };
    if (has_threads() && sees_threads_of_tbb) {
        limit_threads();
        tbb::parallel_sort(items.begin(), items.end(), before);
    } else
        std::sort(items.begin(), items.end(), before);
}

int thread_count() {
    limit_threads();
    return std::min(tbb::this_task_arena::max_concurrency(),
                    int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
}

}  // namespace easypbr
