// Pictures on their way to files: written by threads of their own, in bounded memory.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "easypbr/core/image.h"

namespace easypbr::app {

/// Where the pictures of a recording go.
class FrameWriter {
  public:
    virtual ~FrameWriter() = default;
    /// Writes picture `index`, counted from 0. Called in order when threads() is 1, else by several threads.
    virtual void write(int index, const Image& picture) = 0;
    /// Called once, after the last picture, by the thread that owns the queue.
    virtual void finish() {}
    virtual int threads() const { return 1; }
};

/// Hands pictures to a writer beside the caller's work.
class FrameQueue {
  public:
    /// On as many threads as the writer wants and the system gives. Throws Error where that gives none.
    explicit FrameQueue(std::unique_ptr<FrameWriter> writer);
    /// Waits for what was pushed and finishes the writer; a failure is logged.
    ~FrameQueue();
    FrameQueue(const FrameQueue&) = delete;
    FrameQueue& operator=(const FrameQueue&) = delete;

    /// Waits while a few pictures for each thread are waiting. Throws what writing an earlier one threw.
    void push(Image picture);
    /// Waits until all is written, and finishes the writer. Throws what writing threw; what could be written
    /// is finished nevertheless.
    void finish();
    /// Pictures pushed so far.
    int count() const { return pushed_; }

  private:
    void work();
    void close();

    std::unique_ptr<FrameWriter> writer_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::pair<int, Image>> waiting_;
    std::exception_ptr failure_;
    bool closed_ = false, finished_ = false;
    int pushed_ = 0;
    size_t capacity_;
    std::vector<std::thread> threads_;
};

}  // namespace easypbr::app
