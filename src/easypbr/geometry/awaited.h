// Calls into libraries that cannot be interrupted.
#pragma once

#include <chrono>
#include <cstddef>
#include <future>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "easypbr/core/interrupt.h"

namespace easypbr::geometry {

/// What call() returns. Where this thread may be interrupted and there are many `items`, another thread calls
/// it; when the wait is given up, that one goes on alone to the call's end, so the call must hold all that it
/// uses. Throws Interrupted.
template <class Call>
auto awaited(size_t items, Call call) {
    // Fewer are done before anybody waits.
    constexpr size_t many = 1 << 18;
    if (items < many || !can_be_interrupted()) return call();
    const auto task = std::make_shared<std::packaged_task<decltype(call())()>>(std::move(call));
    auto result = task->get_future();
    try {
        std::thread([task] { (*task)(); }).detach();
    } catch (const std::system_error&) {  // The system gives no other thread.
        (*task)();
    }
    while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) check_interrupt();
    return result.get();
}

}  // namespace easypbr::geometry
