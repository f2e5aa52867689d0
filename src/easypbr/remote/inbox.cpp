#include "easypbr/remote/inbox.h"

#include <utility>

namespace easypbr::remote {
namespace {

const Input* move_of(const Order& order) {
    const auto* input = std::get_if<Input>(&order.message);
    return input && input->event.kind == app::InputEvent::Kind::move ? input : nullptr;
}

}  // namespace

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void Inbox::add(Order order) {
    {
        const std::lock_guard lock(mutex_);
        const bool merges = !orders_.empty() && move_of(order) && move_of(orders_.back()) &&
                            orders_.back().from == order.from;
        if (merges) orders_.pop_back();
        orders_.push_back(std::move(order));
        if (orders_.size() > most_orders) orders_.pop_front();
    }
    wake();
}

void Inbox::add(std::function<void()> task) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    wake();
}

void Inbox::wake() {
    {
        const std::lock_guard lock(mutex_);
        woken_ = true;
    }
    changed_.notify_all();
}

void Inbox::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    changed_.notify_all();
}

bool Inbox::is_closed() const {
    return closed_;
}

bool Inbox::has_orders() const {
    const std::lock_guard lock(mutex_);
    return !orders_.empty();
}

void Inbox::wait(double seconds) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return woken_ || closed_; });
    woken_ = false;
}

std::vector<Order> Inbox::take() {
    const std::lock_guard lock(mutex_);
    std::vector<Order> taken(std::make_move_iterator(orders_.begin()),
                             std::make_move_iterator(orders_.end()));
    orders_.clear();
    return taken;
}

std::vector<std::function<void()>> Inbox::take_tasks() {
    const std::lock_guard lock(mutex_);
    return std::exchange(tasks_, {});
}

}  // namespace easypbr::remote
