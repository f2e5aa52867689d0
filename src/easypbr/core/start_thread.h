// Starting threads where the system may give none.
#pragma once

#include <fmt/format.h>

#include <exception>
#include <system_error>
#include <thread>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr {

/// What start() returns, which starts a thread. Throws Error where the system gives none.
template <class Start>
auto started(Start&& start) {
    try {
        return start();
    } catch (const std::system_error& error) {
        throw Error(
            fmt::format("cannot start a thread: {} (see the limits of processes: ulimit -u, pids.max)",
                        error.code().message()));
    }
}

/// `count` threads that run body(), or as many as the system gives. Throws Error where it gives none.
template <class Body>
std::vector<std::thread> start_threads(size_t count, const Body& body) {
    std::vector<std::thread> threads;
    threads.reserve(count);
    while (threads.size() < count) try {
            threads.push_back(started([&] { return std::thread(body); }));
        } catch (const std::exception&) {
            if (threads.empty()) throw;
            break;
        }
    return threads;
}

}  // namespace easypbr
