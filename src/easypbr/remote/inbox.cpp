#include "easypbr/remote/inbox.h"

#include <algorithm>
#include <iterator>
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
        // What comes between for other views changes nothing in this one.
        const auto last = std::find_if(orders_.rbegin(), orders_.rend(),
                                       [&](const Order& other) { return other.view == order.view; });
        const bool merges =
            last != orders_.rend() && move_of(order) && move_of(*last) && last->from == order.from;
        if (merges) orders_.erase(std::next(last).base());
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

bool Inbox::has_orders(ViewId view) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(orders_, [&](const Order& order) { return order.view == view; });
}

bool Inbox::has_presses(ViewId view) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(orders_, [&](const Order& order) {
        const auto* input = std::get_if<Input>(&order.message);
        const bool presses = input && (input->event.kind == app::InputEvent::Kind::press ||
                                       input->event.kind == app::InputEvent::Kind::scroll ||
                                       input->event.kind == app::InputEvent::Kind::key_down);
        return order.view == view && (presses || std::holds_alternative<Turn>(order.message) ||
                                      std::holds_alternative<SetCamera>(order.message) ||
                                      std::holds_alternative<SetField>(order.message));
    });
}

void Inbox::wait(double seconds) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return woken_ || closed_; });
    woken_ = false;
}

std::vector<Order> Inbox::take(ViewId view) {
    const std::lock_guard lock(mutex_);
    const auto taken = std::stable_partition(orders_.begin(), orders_.end(),
                                             [&](const Order& order) { return order.view != view; });
    std::vector<Order> orders(std::make_move_iterator(taken), std::make_move_iterator(orders_.end()));
    orders_.erase(taken, orders_.end());
    return orders;
}

std::vector<std::function<void()>> Inbox::take_tasks() {
    const std::lock_guard lock(mutex_);
    return std::exchange(tasks_, {});
}

}  // namespace easypbr::remote
