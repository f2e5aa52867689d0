// Log messages reach Python's logging. They wait in a queue until the call that logged them has ended: the
// sink runs on any thread, with locks held, where Python must not be entered.
#include <mutex>
#include <string>
#include <vector>

#include "easypbr/core/log.h"
#include "easypbr/python/bindings.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

struct Message {
    LogLevel level;
    std::string text;
};

std::mutex mutex;
std::vector<Message> waiting;

int python_level(LogLevel level) {
    // The numbers of logging.DEBUG, INFO and WARNING.
    return level == LogLevel::debug ? 10 : level == LogLevel::info ? 20 : 30;
}

}  // namespace

void deliver_log() {
    std::vector<Message> messages;
    {
        const std::lock_guard lock(mutex);
        messages.swap(waiting);
    }
    if (messages.empty()) return;
    try {
        const nb::object logger = nb::module_::import_("logging").attr("getLogger")("easypbr");
        for (const Message& message : messages)
            logger.attr("log")(python_level(message.level), "%s", message.text);
    } catch (nb::python_error& error) {
        error.discard_as_unraisable("easypbr: delivering log messages");
    }
}

void bind_log() {
    set_log_sink([](LogLevel level, std::string_view text) {
        const std::lock_guard lock(mutex);
        waiting.push_back({level, std::string(text)});
    });
}

}  // namespace easypbr::python
