// Messages to the person who looks: shown for some seconds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace easypbr::app {

struct Notification {
    std::string text;
    bool is_error = false;
    double seconds_left = 0;
};

class Notifications {
  public:
    /// Errors stay longer. One that is told again while it is shown stays once, as the newest.
    void add(const std::string& text, bool is_error = false) {
        if (is_error)
            std::erase_if(list_, [&](const Notification& n) { return n.is_error && n.text == text; });
        list_.push_back({text, is_error, is_error ? 12.0 : 5.0});
        ++revision_;
    }
    /// Lets time pass: those whose time is over go.
    void advance(double seconds) {
        if (std::erase_if(list_, [&](Notification& n) { return (n.seconds_left -= seconds) <= 0; }) > 0)
            ++revision_;
    }

    /// Oldest first.
    const std::vector<Notification>& list() const { return list_; }
    /// Grows whenever the list is another one.
    uint64_t revision() const { return revision_; }

  private:
    std::vector<Notification> list_;
    uint64_t revision_ = 0;
};

}  // namespace easypbr::app
