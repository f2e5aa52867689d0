#include "easypbr/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "easypbr/core/interrupt.h"

namespace easypbr {
namespace {

/// EASYPBR_THREADS keeps the loops to as many threads.
void limit_threads() {
    static const std::unique_ptr<tbb::global_control> limit = [] {
        const char* given = std::getenv("EASYPBR_THREADS");
        const int count = given ? std::atoi(given) : 0;
        return count < 1 ? nullptr
                         : std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                                 size_t(count));
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
    const auto run = [&](size_t chunk) {
        check_interrupt();
        body(chunk * grain, std::min(count, (chunk + 1) * grain));
    };
    if (!has_threads()) {
        for (size_t chunk = 0; chunk < chunks; ++chunk) run(chunk);
        return;
    }
    limit_threads();
    tbb::parallel_for(size_t(0), chunks, run);
}

void parallel_sort(std::vector<KeyedIndex>& items) {
    const auto before = [](const KeyedIndex& a, const KeyedIndex& b) {
        return a.key < b.key || (a.key == b.key && a.index < b.index);
    };
    if (has_threads()) {
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
