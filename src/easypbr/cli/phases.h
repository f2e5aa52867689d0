// What a command does now, where the work itself cannot tell how far it is.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace easypbr::cli {

/// Reports progress (core/log.h) from two seconds after its construction on, from a thread of its own: which
/// phase of how many runs, and for how long. Nothing else may report while it lives.
class Phases {
  public:
    /// `count` (above 0) phases follow.
    explicit Phases(int count);
    ~Phases();
    Phases(const Phases&) = delete;
    Phases& operator=(const Phases&) = delete;

    /// The next phase begins, such as "--decimate".
    void begin(std::string what);

  private:
    using Clock = std::chrono::steady_clock;

    void watch();

    const int count_;
    int begun_ = 0;
    std::string what_ = "beginning";
    const Clock::time_point start_ = Clock::now();
    bool is_over_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::thread thread_;
};

}  // namespace easypbr::cli
