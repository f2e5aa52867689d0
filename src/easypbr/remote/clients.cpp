#include "easypbr/remote/clients.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/remote/describe.h"

namespace easypbr::remote {

Clients::Clients(Wire& wire, Inbox& inbox, Tokens tokens, size_t most_clients, HandOver hand_over)
    : wire_(wire),
      inbox_(inbox),
      tokens_(std::move(tokens)),
      most_clients_(most_clients),
      hand_over_(hand_over) {}

void Clients::opened(ClientId client) {
    const std::lock_guard lock(mutex_);
    clients_[client];
}

void Clients::closed(ClientId client) {
    const std::lock_guard lock(mutex_);
    if (clients_.erase(client) == 0) return;
    if (controller_ == client) leave_control(client);
    inbox_.wake();
}

void Clients::received(ClientId id, std::string_view text) {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end()) return;
    try {
        handle(id, found->second, text, now_seconds());
    } catch (const ProtocolError& error) {
        wire_.close(id, CloseCode::refused, error.what());
    }
}

void Clients::handle(ClientId id, Client& client, std::string_view text, double now) {
    ClientMessage message = parse_message(text);
    const auto* drawn = std::get_if<Ack>(&message);
    if (!client.rate.take(now, drawn ? MessageRate::ack_cost : 1)) throw ProtocolError("too many messages");
    if (!client.admitted) return admit(id, client, message, now);
    if (drawn) return ack(id, client, *drawn, now);
    obey(id, client, std::move(message), now);
}

void Clients::admit(ClientId id, Client& client, const ClientMessage& message, double now) {
    const auto* hello = std::get_if<Hello>(&message);
    if (!hello) throw ProtocolError("expected a token first");
    // Both are compared whatever the first says, so that the time tells nothing.
    const bool controls = same_secret(hello->token, tokens_.control) || !tokens_.asked;
    const bool watches = same_secret(hello->token, tokens_.watch);
    if (!controls && !watches) {
        wrong_.add(now);
        return wire_.close(id, CloseCode::wrong_token, "the token is wrong", wrong_.delay_s(now));
    }
    if (admitted() >= most_clients_) return wire_.close(id, CloseCode::full, "there are too many clients");
    client.admitted = true;
    client.may_control = controls;
    wire_.admit(id);
    wire_.send(id, std::make_shared<const std::string>(controls ? welcome_ : watcher_welcome_));
    inbox_.add({id, *hello, now});
    if (controls && !controller_) return give_control(id);
    tell_control();
    pump(id, client, now);
}

void Clients::obey(ClientId id, Client& client, ClientMessage message, double now) {
    if (std::holds_alternative<Hello>(message)) throw ProtocolError("a second token");
    if (const auto* pause = std::get_if<Pause>(&message)) {
        client.paused = pause->paused;
        if (client.paused) client.seat.leave();
        pump(id, client, now);
        return inbox_.wake();
    }
    if (const auto* decodes = std::get_if<Decodes>(&message)) return client.seat.decodes(decodes->h264, now);
    const auto* act = std::get_if<Act>(&message);
    if (act && act->what == Act::What::take_control) return take_control(id, client, now);
    if (controller_ != id)
        return wire_.send(
            id, std::make_shared<const std::string>(notice_text("Somebody else controls this view", true)));
    if (act && act->what == Act::What::leave_control) return leave_control(id);
    if (!std::holds_alternative<Resize>(message)) last_input_s_ = now;
    inbox_.add({id, std::move(message), now});
}

void Clients::ack(ClientId id, Client& client, const Ack& ack, double now) {
    const size_t before = client.flow.count();
    client.flow.drawn(ack.frame, ack.chunk, now);
    const bool counts = client.flow.count() != before && controller_ == id;
    if (counts && newest_ && newest_->moving)
        quality_.drawn(client.flow.latency_s(), client.flow.least_latency_s(), now);
    pump(id, client, now);
    inbox_.wake();
}

void Clients::take_control(ClientId id, Client& client, double now) {
    if (controller_ == id) return;
    const bool is_free =
        hand_over_ == HandOver::at_once || !controller_ || now - last_input_s_ > idle_control_s;
    if (client.may_control && is_free) return give_control(id);
    const std::string why =
        client.may_control ? "Who controls this view is using it" : "This link is for watching only";
    wire_.send(id, std::make_shared<const std::string>(notice_text(why, true)));
    if (client.may_control)
        wire_.send(*controller_, std::make_shared<const std::string>(
                                     notice_text("Somebody asks for control of this view", false)));
}

/// The next in the order in which they came follows.
void Clients::leave_control(ClientId id) {
    controller_.reset();
    for (auto& [other, client] : clients_)
        if (other != id && client.admitted && client.may_control) return give_control(other);
    tell_control();
}

void Clients::give_control(ClientId id) {
    controller_ = id;
    last_input_s_ = -1e9;
    quality_ = {};
    // Held buttons and keys of who had it before are released.
    Input released;
    released.event.kind = app::InputEvent::Kind::focus_lost;
    inbox_.add({id, released, now_seconds()});
    tell_control();
    pump(id, clients_[id], now_seconds());
}

void Clients::tell_control() {
    for (const auto& [id, client] : clients_)
        if (client.admitted)
            wire_.send(id, std::make_shared<const std::string>(control_text(
                               controller_ == id, controller_.has_value(), client.may_control, admitted())));
}

size_t Clients::admitted() const {
    return size_t(std::ranges::count_if(clients_, [](const auto& each) { return each.second.admitted; }));
}

void Clients::set_welcome(std::string text, std::string watcher_text) {
    const std::lock_guard lock(mutex_);
    welcome_ = std::move(text);
    watcher_welcome_ = std::move(watcher_text);
}

void Clients::offer_video(bool offered) {
    const std::lock_guard lock(mutex_);
    offers_video_ = offered;
}

VideoDemand Clients::demand() {
    const std::lock_guard lock(mutex_);
    const double now = now_seconds();
    const bool may_begin = offers_video_ && now - last_key_s_ >= key_wait_s;
    VideoDemand demand;
    for (const auto& [id, client] : clients_) {
        if (!client.admitted || client.paused) continue;
        if (offers_video_ && client.seat.is_in())
            demand.video = true;
        else if (client.flow.has_room())
            (may_begin && client.seat.wants_key(now) ? demand.key : demand.jpeg) = true;
    }
    if (demand.key) last_key_s_ = now;
    demand.video |= demand.key;
    return demand;
}

bool Clients::publish(Picture picture) {
    const uint32_t frame = picture.header.frame;
    return take_newest({frame, false, std::move(picture), {}});
}

bool Clients::publish(MovingPicture picture) {
    const FrameHeader& header = picture.video ? picture.video->picture.header : picture.jpeg->header;
    const uint32_t frame = header.frame;
    return take_newest({frame, true, std::move(picture.jpeg), std::move(picture.video)});
}

bool Clients::take_newest(Newest newest) {
    const std::lock_guard lock(mutex_);
    if (newest_ && newest.frame <= newest_->frame) return false;
    newest_ = std::move(newest);
    const double now = now_seconds();
    for (auto& [id, client] : clients_) pump(id, client, now);
    return true;
}

void Clients::pump(ClientId id, Client& client, double now) {
    if (!client.admitted) return;
    pump_shot(id, client, now);
    if (!newest_ || client.paused) return;
    if (newest_->moving) return pump_moving(id, client, now);
    if (client.frame != newest_->frame) {
        client.frame = newest_->frame;
        client.from = 0;
        client.chunk = 0;
        client.done = false;
    }
    while (!client.done && client.flow.has_chunk_room()) {
        send_part(id, client, *newest_->picture, client.from, client.chunk, false, now);
        client.done = client.from == newest_->picture->bytes->size();
    }
}

/// As a whole: the next one replaces it.
void Clients::pump_moving(ClientId id, Client& client, double now) {
    if (client.frame == newest_->frame || !client.flow.has_room()) return;
    client.frame = newest_->frame;
    client.done = true;
    const Picture* picture = version_for(client, now);
    if (!picture) return;
    if (controller_ == id) quality_.use_video(picture->header.codec == Codec::h264);
    size_t from = 0;
    uint16_t chunk = 0;
    send_part(id, client, *picture, from, chunk, true, now);
}

/// Null: it can do nothing with any, and waits for the next.
const Picture* Clients::version_for(Client& client, double now) {
    const auto& video = newest_->video;
    if (video && client.seat.can_take(video->mark)) {
        client.seat.took(video->mark, now);
        return &video->picture;
    }
    if (video) client.seat.missed(now);
    return newest_->picture ? &*newest_->picture : nullptr;
}

void Clients::pump_shot(ClientId id, Client& client, double now) {
    while (!client.shots.empty() && client.flow.has_chunk_room()) {
        const Picture& shot = client.shots.front();
        send_part(id, client, shot, client.shot_from, client.shot_chunk, false, now);
        if (client.shot_from < shot.bytes->size()) continue;
        client.shots.pop_front();
        client.shot_from = 0;
        client.shot_chunk = 0;
    }
}

void Clients::send_part(ClientId id, Client& client, const Picture& picture, size_t& from, uint16_t& chunk,
                        bool whole, double now) {
    Packet packet{picture.header, picture.bytes, from, picture.bytes->size() - from};
    if (!whole) packet.count = std::min(packet.count, chunk_bytes);
    from += packet.count;
    packet.header.chunk = chunk++;
    packet.header.bytes = uint32_t(picture.bytes->size());
    if (from == picture.bytes->size()) packet.header.flags |= FrameHeader::last;
    client.flow.sent(packet.header.frame, packet.header.chunk, packet.count, now);
    wire_.send(id, std::move(packet));
}

void Clients::send_shot(ClientId id, Picture picture) {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end()) return;
    if (found->second.shots.size() >= most_shots) return;
    found->second.shots.push_back(std::move(picture));
    pump(id, found->second, now_seconds());
}

void Clients::broadcast(const std::string& text) {
    const auto shared = std::make_shared<const std::string>(text);
    const std::lock_guard lock(mutex_);
    for (const auto& [id, client] : clients_)
        if (client.admitted) wire_.send(id, shared);
}

void Clients::tell(ClientId client, const std::string& text) {
    wire_.send(client, std::make_shared<const std::string>(text));
}

std::vector<ClientState> Clients::states() const {
    const std::lock_guard lock(mutex_);
    std::vector<ClientState> states;
    for (const auto& [id, client] : clients_)
        if (client.admitted)
            states.push_back(
                {id, controller_ == id, !client.may_control, client.paused, client.flow.latency_s()});
    return states;
}

bool Clients::anybody() const {
    const std::lock_guard lock(mutex_);
    return admitted() > 0;
}

bool Clients::anybody_looks() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(clients_,
                               [](const auto& each) { return each.second.admitted && !each.second.paused; });
}

const Clients::Client* Clients::looking_controller() const {
    if (!controller_) return nullptr;
    const Client& client = clients_.at(*controller_);
    return client.paused || client.flow.waits_s(now_seconds()) > silent_s ? nullptr : &client;
}

bool Clients::has_room(size_t coming) const {
    const std::lock_guard lock(mutex_);
    if (const Client* controller = looking_controller()) return controller->flow.has_room(coming);
    return std::ranges::any_of(clients_, [&](const auto& each) {
        return each.second.admitted && !each.second.paused && each.second.flow.has_room(coming);
    });
}

bool Clients::has_delivered() const {
    const std::lock_guard lock(mutex_);
    if (!newest_) return true;
    const auto has = [&](const Client& client) {
        return client.frame == newest_->frame && client.done && client.flow.count() == 0;
    };
    if (const Client* controller = looking_controller()) return has(*controller);
    return std::ranges::any_of(clients_, [&](const auto& each) { return has(each.second); });
}

WireQuality Clients::quality() const {
    const std::lock_guard lock(mutex_);
    return quality_;
}

}  // namespace easypbr::remote
