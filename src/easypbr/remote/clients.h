// Clients: who is connected, who controls, and what each is sent.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/remote/flow.h"
#include "easypbr/remote/gate.h"
#include "easypbr/remote/inbox.h"
#include "easypbr/remote/token.h"
#include "easypbr/remote/video_seat.h"
#include "easypbr/remote/wire.h"

namespace easypbr::remote {

/// A picture, encoded once for all. `header.frame` grows.
struct Picture {
    FrameHeader header;
    SharedBytes bytes;
};

/// A picture of something that moves, as the clients need it.
struct MovingPicture {
    struct Video {
        Picture picture;
        VideoMark mark;
    };
    std::optional<Video> video;
    std::optional<Picture> jpeg;
};

/// What the next moving picture is needed as.
struct VideoDemand {
    bool video = false;
    bool key = false;  ///< somebody begins with it
    bool jpeg = false;
};

/// Views of clients' own.
struct OwnViewRules {
    size_t most = 0;            ///< at a time
    bool for_watchers = false;  ///< who may only watch may have one too
};

/// One of them.
struct OwnViewOf {
    ViewId id = shared_view;
    bool watches_only = false;
    Vec2i size{1, 1};
};

/// What a program may ask about a client.
struct ClientState {
    ClientId id = 0;
    ViewId view = shared_view;
    bool controls = false, watches_only = false, paused = false;
    double latency_s = 0;  ///< from sending a picture to the answer that it is drawn
};

/// When a client that may control gets control from another one.
enum class HandOver {
    when_idle,  ///< clients are of several persons: who uses it keeps it
    at_once     ///< clients are of one person
};

/// All begin with the shared view: one client at a time controls it, of those that may, and all see the same
/// pictures. In a view of its own a client controls what is not the scene's. Each gets the newest picture of
/// its view at its own pace: nothing is queued. Used from any thread.
class Clients : public WireEvents {
  public:
    /// All must outlive it.
    Clients(Wire& wire, Inbox& inbox, Tokens tokens, size_t most_clients,
            HandOver hand_over = HandOver::when_idle, OwnViewRules own_views = {});

    void opened(ClientId client) override;
    void received(ClientId client, std::string_view text) override;
    void closed(ClientId client) override;

    /// What a client is told first; the rest follows once it has been told who controls.
    void set_welcome(std::string text, std::string watcher_text);
    /// Whether there is a video for those who decode it; at first there is none.
    void offer_video(bool offered);
    /// Those that there shall be.
    std::vector<OwnViewOf> own_views() const;
    /// Pictures are numbered through all views, beginning with 1.
    uint32_t next_frame() { return ++frames_; }
    /// Whoever is told that a key frame is needed makes one.
    VideoDemand demand(ViewId view);
    /// The newest picture of a view. One with an older number than the last is dropped; returns whether it
    /// was taken.
    bool publish(ViewId view, Picture picture);
    bool publish(ViewId view, MovingPicture picture);
    /// Chunks of a still or a file for one client, after those that it waits for already.
    void send_shot(ClientId client, Picture picture);
    /// Without `for_watchers` not to those who may watch only.
    void broadcast(ViewId view, const std::string& text, bool for_watchers = true);
    void tell(ClientId client, const std::string& text, bool for_watchers = true);

    std::vector<ClientState> states() const;
    bool anybody() const;
    /// The client is connected.
    bool is_there(ClientId client) const;
    /// Somebody is connected and can see the view's picture.
    bool anybody_looks(ViewId view) const;
    /// A picture that is drawn now, beside so many that are being coded, can be sent to who controls, or,
    /// when nobody does or it does not answer for seconds, to somebody.
    bool has_room(ViewId view, size_t coming) const;
    /// Who looks has the newest picture.
    bool has_delivered(ViewId view) const;
    /// Of moving pictures, as the controlling client's line allows.
    WireQuality quality(ViewId view) const;

    /// Who controls may be asked to let go after this time without input.
    static constexpr double idle_control_s = 5;
    static constexpr double silent_s = 2;
    static constexpr size_t chunk_bytes = 32 * 1024;
    /// That wait for one client; more are dropped.
    static constexpr size_t most_shots = 8;
    /// Key frames for those who come are at least so far apart.
    static constexpr double key_wait_s = 1;

  private:
    struct Client {
        bool admitted = false, may_control = false, paused = false;
        ViewId view = shared_view;
        Vec2i own_size{1, 1};  ///< when it asked for a view of its own
        FlowControl flow;
        MessageRate rate;
        VideoSeat seat;
        uint32_t frame = 0;  ///< newest picture that it was sent, or is being sent
        size_t from = 0;     ///< bytes of it that were sent
        uint16_t chunk = 0;
        bool done = true;           ///< all of it was sent
        std::deque<Picture> shots;  ///< the first is being sent
        size_t shot_from = 0;
        uint16_t shot_chunk = 0;

        bool looks_at(ViewId other) const { return admitted && !paused && view == other; }
    };

    struct Newest {
        uint32_t frame = 0;
        bool moving = false;
        std::optional<Picture> picture;  ///< for all
        std::optional<MovingPicture::Video> video;
    };

    /// What belongs to a view.
    struct Group {
        std::optional<ClientId> controller;
        double last_input_s = -1e9;
        std::optional<Newest> newest;
        double last_key_s = -1e9;
        WireQuality quality;
    };

    void handle(ClientId id, Client& client, std::string_view text, double now);
    void admit(ClientId id, Client& client, const ClientMessage& message, double now);
    void obey(ClientId id, Client& client, ClientMessage message, double now);
    void ack(ClientId id, Client& client, const Ack& ack, double now);
    /// Why a message is not obeyed; empty: it is.
    std::string refusal(ClientId id, const Client& client, const ClientMessage& message) const;
    void switch_view(ClientId id, Client& client, const OwnView& wish, double now);
    std::string own_view_refusal(const Client& client) const;
    static void look_at(Client& client, ViewId view);
    ViewId free_view();
    void refuse(ClientId id, const std::string& why);
    void take_control(ClientId id, Client& client, double now);
    void leave_control(ClientId id);
    void give_control(ClientId id);
    void tell_control();
    void pump(ClientId id, Client& client, double now);
    void pump_moving(ClientId id, Client& client, double now);
    const Picture* version_for(Client& client, double now);
    bool take_newest(ViewId view, Newest newest);
    void pump_shot(ClientId id, Client& client, double now);
    void send_part(ClientId id, Client& client, const Picture& picture, size_t& from, uint16_t& chunk,
                   bool whole, double now);
    const Client* looking_controller(const Group& group) const;
    size_t admitted() const;
    /// Views may end while their thread still draws: then null.
    const Group* group(ViewId view) const;

    Wire& wire_;
    Inbox& inbox_;
    const Tokens tokens_;
    const size_t most_clients_;
    const HandOver hand_over_;
    const OwnViewRules own_views_;
    std::atomic<uint32_t> frames_ = 0;

    mutable std::mutex mutex_;
    std::map<ClientId, Client> clients_;
    std::map<ViewId, Group> groups_{{shared_view, {}}};
    ViewId last_view_ = shared_view;
    bool offers_video_ = false;
    WrongTokens wrong_;
    std::string welcome_, watcher_welcome_;
};

}  // namespace easypbr::remote
