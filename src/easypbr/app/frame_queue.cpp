#include "easypbr/app/frame_queue.h"

#include "easypbr/core/log.h"
#include "easypbr/core/start_thread.h"

namespace easypbr::app {

FrameQueue::FrameQueue(std::unique_ptr<FrameWriter> writer)
    : writer_(std::move(writer)), capacity_(2 + size_t(writer_->threads())) {
    threads_ = start_threads(size_t(writer_->threads()), [this] { work(); });
}

FrameQueue::~FrameQueue() {
    try {
        finish();
    } catch (const std::exception& error) {
        log_warning(error.what());
    }
}

void FrameQueue::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        const auto [index, picture] = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
        if (failure_) continue;
        lock.unlock();
        std::exception_ptr failure;
        try {
            writer_->write(index, picture);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        if (failure && !failure_) failure_ = failure;
        changed_.notify_all();
    }
}

void FrameQueue::push(Image picture) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < capacity_ || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    waiting_.emplace_back(pushed_++, std::move(picture));
    changed_.notify_all();
}

void FrameQueue::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_all();
    }
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
}

void FrameQueue::finish() {
    if (finished_) return;
    finished_ = true;
    close();
    try {
        writer_->finish();
    } catch (...) {
        // The first failure says more than what follows from it.
        if (!failure_) failure_ = std::current_exception();
    }
    if (failure_) std::rethrow_exception(failure_);
}

}  // namespace easypbr::app
