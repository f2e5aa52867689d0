// Log messages reach Python's logging. They wait in a queue until the call that logged them has ended: the
// sink runs on any thread, with locks held, where Python must not be entered.
#include <mutex>
#include <optional>
#include <string>
#include <utility>
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

void deliver(const Message& message) {
    const nb::object logger = nb::module_::import_("logging").attr("getLogger")("easypbr");
    logger.attr("log")(python_level(message.level), "%s", message.text);
}

}  // namespace

void deliver_log() {
    std::vector<Message> messages;
    {
        const std::lock_guard lock(mutex);
        messages.swap(waiting);
    }
    constexpr const char* context = "easypbr: delivering log messages";
    std::optional<nb::python_error> ending;  // KeyboardInterrupt, SystemExit
    for (const Message& message : messages) {
        try {
            deliver(message);
        } catch (nb::python_error& error) {
            if (ending || error.matches(PyExc_Exception))
                error.discard_as_unraisable(context);
            else
                ending.emplace(std::move(error));
        }
    }
    if (ending) raise_later(std::move(*ending), context);
}

void bind_log() {
    set_log_sink([](LogLevel level, std::string_view text) {
        const std::lock_guard lock(mutex);
        waiting.push_back({level, std::string(text)});
    });
}

}  // namespace easypbr::python
