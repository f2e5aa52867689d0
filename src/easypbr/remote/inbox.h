// What clients and the program ask of the thread that draws.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <vector>

#include "easypbr/remote/messages.h"
#include "easypbr/remote/wire.h"

namespace easypbr::remote {

/// Seconds of a steady clock.
double now_seconds();

/// A message of a client, and when it came.
struct Order {
    ClientId from = 0;
    ClientMessage message;
    double arrived_s = 0;
    ViewId view = shared_view;  ///< that the client looks at
};

/// Filled by any thread, emptied by one.
class Inbox {
  public:
    /// A pointer that moves on takes the place of its last move. What is too much is dropped, oldest first.
    void add(Order order);
    /// A task of the program, or of the server itself.
    void add(std::function<void()> task);
    /// Lets wait() return.
    void wake();
    /// No wait from now on.
    void close();
    bool is_closed() const;

    /// For this view.
    bool has_orders(ViewId view = shared_view) const;
    /// Whether some of those turn the camera or change a setting, or may begin to.
    bool has_presses(ViewId view = shared_view) const;
    /// Until something comes, wake() is called, or the time is over.
    void wait(double seconds);
    /// Those for this view.
    std::vector<Order> take(ViewId view = shared_view);
    std::vector<std::function<void()>> take_tasks();

    static constexpr size_t most_orders = 4096;

  private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Order> orders_;
    std::vector<std::function<void()>> tasks_;
    bool woken_ = false;
    std::atomic<bool> closed_ = false;
};

}  // namespace easypbr::remote
