// Functions of a program that are called while a person looks at its session.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "easypbr/app/input.h"
#include "easypbr/app/notifications.h"

namespace easypbr::app {

/// Takes an event; true: nobody else shall act on it.
using EventHandler = std::function<bool(const InputEvent&)>;

/// Handlers may add and remove others. What they throw becomes a notification, once for each text.
class EventHandlers {
  public:
    /// The notifications must outlive it.
    explicit EventHandlers(Notifications& notifications) : notifications_(notifications) {}

    /// Returns a number for remove(). Throws ArgumentError for a handler that is no function.
    int add(EventHandler handler);
    void remove(int number) { handlers_.erase(number); }
    bool empty() const { return handlers_.empty(); }
    /// A number that no handler has.
    int next_number() { return next_++; }

    /// Offers an event to all. Returns whether one of them took it.
    bool offer(const InputEvent& event);

    /// Calls any function of the program. Returns whether it threw nothing.
    bool guarded(const std::function<void()>& function);
    /// Tells the next failure even if it has the text of the last one.
    void forget_failure() { last_failure_.clear(); }

  private:
    Notifications& notifications_;
    std::map<int, EventHandler> handlers_;
    int next_ = 1;
    std::string last_failure_;
};

}  // namespace easypbr::app
