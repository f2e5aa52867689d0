#include "easypbr/io/mesh/mesh_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/core/start_thread.h"
#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::io {

MeshQueue::MeshQueue(std::vector<std::filesystem::path> paths, int workers, int prefetch)
    : paths_(std::move(paths)), prefetch_(size_t(std::max(prefetch, 0))) {
    if (workers < 1 || prefetch < 1)
        throw ArgumentError(
            fmt::format("mesh loader: expected at least 1 worker and 1 mesh read ahead, got {} and {}",
                        workers, prefetch));
    const size_t count = std::min({size_t(workers), prefetch_, paths_.size()});
    threads_ = start_threads(count, [this] { work(); });
}

MeshQueue::~MeshQueue() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void MeshQueue::work() {
    const InterruptScope scope([this] { return stop_.load(std::memory_order_relaxed); });
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock,
                      [&] { return stop_ || claimed_ >= paths_.size() || claimed_ < given_ + prefetch_; });
        if (stop_ || claimed_ >= paths_.size()) return;
        const size_t place = claimed_++;
        lock.unlock();
        Result result;
        try {
            result.mesh = Mesh(paths_[place]);
        } catch (...) {
            result.error = std::current_exception();
        }
        lock.lock();
        results_[place] = std::move(result);
        changed_.notify_all();
    }
}

std::optional<Mesh> MeshQueue::next() {
    std::unique_lock lock(mutex_);
    if (given_ >= paths_.size()) return std::nullopt;
    using namespace std::chrono_literals;
    while (!changed_.wait_for(lock, 20ms, [&] { return results_.contains(given_); })) check_interrupt();
    Result result = std::move(results_.extract(given_).mapped());
    ++given_;
    lock.unlock();
    changed_.notify_all();
    if (result.error) std::rethrow_exception(result.error);
    return result.mesh;
}

}  // namespace easypbr::io
