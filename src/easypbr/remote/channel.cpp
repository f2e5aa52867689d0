#include "easypbr/remote/server.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "easypbr/core/own_process.h"
#include "easypbr/remote/mailbox.h"
#include "easypbr/remote/served_files.h"
#include "easypbr/remote/views.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {
namespace {

constexpr size_t most_channel_clients = 64;

}  // namespace

struct Channel::Parts {
    Parts(const Scene& scene, const Settings& settings)
        : clients(mailbox, inbox, {random_token(), random_token(), false}, most_channel_clients,
                  HandOver::at_once),
          views(scene, settings, inbox, clients) {
        const std::string text = welcome_text(random_token().substr(0, 16), false);
        clients.set_welcome(text, text);
        views.start();
    }

    /// Whether it was there.
    bool forget(ClientId client) {
        {
            const std::lock_guard lock(mutex);
            if (!attendance.drop(client)) return false;
        }
        clients.closed(client);
        return true;
    }

    void forget_silent() {
        std::vector<ClientId> silent;
        {
            const std::lock_guard lock(mutex);
            silent = attendance.drop_silent(now_seconds());
        }
        for (const ClientId client : silent) clients.closed(client);
    }

    const OwnProcess process;  ///< of the threads
    Inbox inbox;
    Mailbox mailbox;
    Clients clients;
    Views views;
    mutable std::mutex mutex;  ///< of `attendance`
    Attendance attendance;
    std::mutex closing;
    std::atomic<bool> open = true;
};

Channel::Channel(const Scene& scene, const Settings& settings)
    : parts_(std::make_unique<Parts>(scene, settings)) {}

Channel::~Channel() {
    if (!parts_->process.is_this()) {
        static_cast<void>(parts_.release());
        return;
    }
    close();
    if (!parts_->views.draws_here()) return;
    // The last one that used it was a panel's function: the thread that it runs on cannot wait for itself.
    std::thread([parts = std::shared_ptr<Parts>(std::move(parts_))] { parts->views.stop(); }).detach();
}

void Channel::receive(uint64_t client, std::string_view text) {
    Parts& parts = *parts_;
    if (!is_open()) return;
    bool is_new = false;
    {
        const std::lock_guard lock(parts.mutex);
        if (text.empty() && !parts.attendance.knows(client)) return;
        is_new = parts.attendance.note(client, now_seconds());
    }
    if (is_new) parts.clients.opened(client);
    if (!text.empty()) parts.clients.received(client, text);
}

void Channel::leave(uint64_t client) {
    if (is_open()) parts_->forget(client);
}

std::vector<ChannelMessage> Channel::take(double seconds) {
    Parts& parts = *parts_;
    if (!is_open()) return {};
    parts.forget_silent();
    std::vector<ChannelMessage> messages = parts.mailbox.take(seconds);
    for (const ChannelMessage& message : messages)
        if (message.close_code > 0) parts.forget(message.client);
    return messages;
}

size_t Channel::client_count() const {
    const std::lock_guard lock(parts_->mutex);
    return parts_->attendance.count();
}

void Channel::take_settings(const Settings& settings) {
    if (is_open()) parts_->views.take_settings(settings);
}

void Channel::add_animations(const std::string& name, const Animations& animations) {
    if (is_open()) parts_->views.add_animations(name, animations);
}

void Channel::add_panel(const std::string& name, std::function<void(app::Widgets&)> function) {
    if (is_open()) parts_->views.add_panel(name, std::move(function));
}

void Channel::remove_panel(const std::string& name) {
    if (is_open()) parts_->views.remove_panel(name);
}

void Channel::close() {
    // A panel's function that closes what draws it waits for nobody: whoever closes meanwhile waits for it.
    if (!parts_->process.is_this()) return;
    std::unique_lock lock(parts_->closing, std::defer_lock);
    if (!parts_->views.draws_here()) lock.lock();
    if (parts_->open.exchange(false)) parts_->mailbox.shut();
    parts_->views.stop();
}

bool Channel::is_open() const {
    return parts_->open;
}

}  // namespace easypbr::remote
