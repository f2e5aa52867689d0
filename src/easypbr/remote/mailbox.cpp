#include "easypbr/remote/mailbox.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace easypbr::remote {

void Mailbox::add(ChannelMessage message) {
    {
        const std::lock_guard lock(mutex_);
        if (shut_) return;
        waiting_.push_back(std::move(message));
    }
    changed_.notify_all();
}

void Mailbox::send(ClientId client, SharedText text) {
    add({client, *text, {}, 0});
}

void Mailbox::send(ClientId client, Packet packet) {
    const auto header = packet.header.encoded();
    ChannelMessage message{client, {}, std::vector<std::byte>(header.size() + packet.count), 0};
    const auto rest = std::ranges::copy(header, message.bytes.begin()).out;
    std::copy_n(packet.bytes->begin() + std::ptrdiff_t(packet.from), packet.count, rest);
    add(std::move(message));
}

void Mailbox::close(ClientId client, CloseCode code, const std::string& reason, double) {
    add({client, reason, {}, int(code)});
}

std::vector<ChannelMessage> Mailbox::take(double seconds) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                      [&] { return shut_ || !waiting_.empty(); });
    return std::exchange(waiting_, {});
}

void Mailbox::shut() {
    {
        const std::lock_guard lock(mutex_);
        shut_ = true;
        waiting_.clear();
    }
    changed_.notify_all();
}

}  // namespace easypbr::remote
