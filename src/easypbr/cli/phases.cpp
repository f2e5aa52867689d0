#include "easypbr/cli/phases.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "easypbr/core/log.h"

namespace easypbr::cli {

using namespace std::chrono_literals;

Phases::Phases(int count) : count_(std::max(count, 1)) {
    try {
        thread_ = std::thread([this] { watch(); });
    } catch (const std::system_error&) {  // The work goes on without its progress.
    }
}

Phases::~Phases() {
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Phases::begin(std::string what) {
    const std::lock_guard lock(mutex_);
    what_ = std::move(what);
    ++begun_;
}

void Phases::watch() {
    std::unique_lock lock(mutex_);
    const auto over = [this] { return is_over_; };
    if (changed_.wait_for(lock, 2s, over)) return;
    do {
        const long seconds = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_).count();
        report_progress(
            fmt::format("{}, {} of {}, for {}:{:02}", what_, begun_, count_, seconds / 60, seconds % 60),
            double(std::max(begun_ - 1, 0)) / count_);
    } while (!changed_.wait_for(lock, 200ms, over));
    report_progress(what_, 1);
}

}  // namespace easypbr::cli
