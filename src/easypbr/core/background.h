// What a thread of its own makes while the others go on.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "easypbr/core/own_process.h"

namespace easypbr {

/// Work on a thread of its own. With one thread for all (EASYPBR_THREADS=1), or where the system gives no
/// other, it is done at once. What it throws ends it. The end of the process interrupts it.
class BackgroundWork {
  public:
    explicit BackgroundWork(std::function<void()> work);
    /// Interrupts the work, and waits until it has stopped. What it uses must live so long.
    ~BackgroundWork();
    BackgroundWork(const BackgroundWork&) = delete;
    BackgroundWork& operator=(const BackgroundWork&) = delete;

    /// Waits for all work of the process: for tests and measurements.
    static void wait_for_all();

  private:
    void run();

    std::function<void()> work_;  ///< dropped where the object is: Python's arrays may be in it
    std::atomic<bool> stops_ = false;
    std::unique_ptr<std::thread, DeleteInOwnProcess> thread_;
};

/// A value that background work makes.
template <class Value>
class BackgroundValue {
  public:
    template <class Make>
    explicit BackgroundValue(Make make)
        : work_([this, make = std::move(make)] {
              value_.emplace(make());
              is_made_.store(true, std::memory_order_release);
          }) {}

    /// Null until it is made, and where making it failed.
    const Value* get() const { return is_made_.load(std::memory_order_acquire) ? &*value_ : nullptr; }

  private:
    std::optional<Value> value_;
    std::atomic<bool> is_made_ = false;
    BackgroundWork work_;  ///< the last member: it uses the others
};

}  // namespace easypbr
