#include "easypbr/core/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace easypbr {

void parallel_chunks(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    grain = std::max<size_t>(grain, 1);
    const size_t chunks = (count + grain - 1) / grain;
    if (chunks <= 1) {
        if (count) body(0, count);
        return;
    }
    tbb::parallel_for(size_t(0), chunks,
                      [&](size_t chunk) { body(chunk * grain, std::min(count, (chunk + 1) * grain)); });
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
    tbb::parallel_invoke(first, second);
}

int thread_count() {
    return tbb::this_task_arena::max_concurrency();
}

}  // namespace easypbr
