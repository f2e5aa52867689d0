#include "easypbr/core/background.h"

#include <condition_variable>
#include <mutex>
#include <system_error>
#include <utility>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/parallel.h"

namespace easypbr {
namespace {

/// The threads that work at this moment.
class Working {
  public:
    static Working& get() {
        static Working working;
        return working;
    }
    /// Before what they use is gone: the object is younger than the libraries' own.
    ~Working() {
        if (!process_.is_this()) return;
        ends_ = true;
        wait();
    }
    bool ends() const { return ends_; }
    void add(int difference) {
        const std::lock_guard lock(mutex_);
        count_ += difference;
        changed_.notify_all();
    }
    void wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return count_ == 0; });
    }

  private:
    const OwnProcess process_{};
    std::atomic<bool> ends_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
    int count_ = 0;
};

}  // namespace

BackgroundWork::BackgroundWork(std::function<void()> work) : work_(std::move(work)) {
    if (thread_count() > 1) {
        Working& working = Working::get();
        working.add(1);
        try {
            thread_.reset(new std::thread([this, &working] {
                run();
                working.add(-1);
            }));
            return;
        } catch (const std::system_error&) {
            working.add(-1);
        }
    }
    run();
}

BackgroundWork::~BackgroundWork() {
    stops_ = true;
    if (thread_ && thread_.get_deleter().process.is_this()) thread_->join();
}

void BackgroundWork::run() {
    try {
        const InterruptScope scope([this] { return stops_ || Working::get().ends(); });
        work_();
    } catch (...) {  // Whoever started it goes on without.
    }
}

void BackgroundWork::wait_for_all() {
    Working::get().wait();
}

}  // namespace easypbr
