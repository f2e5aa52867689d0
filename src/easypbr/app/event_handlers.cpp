#include "easypbr/app/event_handlers.h"

#include <utility>

#include "easypbr/core/error.h"

namespace easypbr::app {

int EventHandlers::add(EventHandler handler) {
    if (!handler) throw ArgumentError("on_event: expected a function");
    const int number = next_number();
    handlers_[number] = std::move(handler);
    return number;
}

bool EventHandlers::offer(const InputEvent& event) {
    bool taken = false;
    const auto present = handlers_;  // They may add and remove others.
    for (const auto& entry : present) guarded([&] { taken |= entry.second(event); });
    return taken;
}

bool EventHandlers::guarded(const std::function<void()>& function) {
    std::string text;
    try {
        function();
        return true;
    } catch (const std::exception& error) {
        text = error.what();
    } catch (...) {
        text = "an exception that is no std::exception";
    }
    // The same in every frame would hide the picture.
    if (std::exchange(last_failure_, text) != text) notifications_.add(text, true);
    return false;
}

}  // namespace easypbr::app
