// Mailbox: the wire of a channel. What is sent waits here until the program takes it.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <vector>

#include "easypbr/remote/server.h"
#include "easypbr/remote/wire.h"

namespace easypbr::remote {

class Mailbox : public Wire {
  public:
    void admit(ClientId) override {}
    void send(ClientId client, SharedText text) override;
    void send(ClientId client, Packet packet) override;
    /// At once: clients of one person need no delay.
    void close(ClientId client, CloseCode code, const std::string& reason, double delay_s) override;

    std::vector<ChannelMessage> take(double seconds);
    /// No wait from now on, and nothing more to take.
    void shut();

  private:
    void add(ChannelMessage message);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<ChannelMessage> waiting_;
    bool shut_ = false;
};

/// When each client was heard of last.
class Attendance {
  public:
    /// Returns whether it is new.
    bool note(ClientId client, double now_s) {
        const bool is_new = !heard_.contains(client);
        heard_[client] = now_s;
        return is_new;
    }
    bool drop(ClientId client) { return heard_.erase(client) > 0; }
    /// Takes out those that were silent for too long.
    std::vector<ClientId> drop_silent(double now_s) {
        std::vector<ClientId> silent;
        for (const auto& [client, heard_s] : heard_)
            if (now_s - heard_s > longest_silence_s) silent.push_back(client);
        for (const ClientId client : silent) heard_.erase(client);
        return silent;
    }
    bool knows(ClientId client) const { return heard_.contains(client); }
    size_t count() const { return heard_.size(); }

    /// Browsers let hidden pages act once a minute.
    static constexpr double longest_silence_s = 180;

  private:
    std::map<ClientId, double> heard_;
};

}  // namespace easypbr::remote
