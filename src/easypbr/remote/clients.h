// Clients: who is connected, who controls, and what each is sent.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/remote/flow.h"
#include "easypbr/remote/gate.h"
#include "easypbr/remote/inbox.h"
#include "easypbr/remote/token.h"
#include "easypbr/remote/wire.h"

namespace easypbr::remote {

/// A picture, encoded once for all. `header.frame` grows.
struct Picture {
    FrameHeader header;
    SharedBytes bytes;
};

/// What a program may ask about a client.
struct ClientState {
    ClientId id = 0;
    bool controls = false, watches_only = false, paused = false;
    double latency_s = 0;  ///< from sending a picture to the answer that it is drawn
};

/// When a client that may control gets control from another one.
enum class HandOver {
    when_idle,  ///< clients are of several persons: who uses it keeps it
    at_once     ///< clients are of one person
};

/// One client at a time controls, of those that may; all see the same pictures. Each gets the newest one at
/// its own pace: nothing is queued. Used from any thread.
class Clients : public WireEvents {
  public:
    /// All must outlive it.
    Clients(Wire& wire, Inbox& inbox, Tokens tokens, size_t most_clients,
            HandOver hand_over = HandOver::when_idle);

    void opened(ClientId client) override;
    void received(ClientId client, std::string_view text) override;
    void closed(ClientId client) override;

    /// What a client is told first; the rest follows once it has been told who controls.
    void set_welcome(std::string text, std::string watcher_text);
    /// The newest picture. One with an older number than the last is dropped.
    void publish(Picture picture);
    /// Chunks of a still for one client.
    void send_shot(ClientId client, Picture picture);
    void broadcast(const std::string& text);
    void tell(ClientId client, const std::string& text);

    std::vector<ClientState> states() const;
    bool anybody() const;
    /// Somebody is connected and can see the picture.
    bool anybody_looks() const;
    /// A picture that is drawn now can be sent to who controls, or, when nobody does or it does not answer
    /// for seconds, to somebody.
    bool has_room() const;
    /// Who looks has the newest picture.
    bool has_delivered() const;
    /// Of moving pictures, as the controlling client's line allows.
    WireQuality quality() const;

    /// Who controls may be asked to let go after this time without input.
    static constexpr double idle_control_s = 5;
    static constexpr double silent_s = 2;
    static constexpr size_t chunk_bytes = 32 * 1024;

  private:
    struct Client {
        bool admitted = false, may_control = false, paused = false;
        FlowControl flow;
        MessageRate rate;
        uint32_t frame = 0;  ///< newest picture that it was sent, or is being sent
        size_t from = 0;     ///< bytes of it that were sent
        uint16_t chunk = 0;
        bool done = true;  ///< all of it was sent
        std::optional<Picture> shot;
        size_t shot_from = 0;
        uint16_t shot_chunk = 0;
    };

    void handle(ClientId id, Client& client, std::string_view text, double now);
    void admit(ClientId id, Client& client, const ClientMessage& message, double now);
    void obey(ClientId id, Client& client, ClientMessage message, double now);
    void ack(ClientId id, Client& client, const Ack& ack, double now);
    void take_control(ClientId id, Client& client, double now);
    void leave_control(ClientId id);
    void give_control(ClientId id);
    void tell_control();
    void pump(ClientId id, Client& client, double now);
    void pump_shot(ClientId id, Client& client, double now);
    void send_part(ClientId id, Client& client, const Picture& picture, size_t& from, uint16_t& chunk,
                   bool whole, double now);
    const Client* looking_controller() const;
    size_t admitted() const;

    Wire& wire_;
    Inbox& inbox_;
    const Tokens tokens_;
    const size_t most_clients_;
    const HandOver hand_over_;

    mutable std::mutex mutex_;
    std::map<ClientId, Client> clients_;
    std::optional<ClientId> controller_;
    double last_input_s_ = -1e9;
    std::optional<Picture> newest_;
    WireQuality quality_;
    WrongTokens wrong_;
    std::string welcome_, watcher_welcome_;
};

}  // namespace easypbr::remote
