#include "easypbr/remote/clients.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/remote/describe.h"

namespace easypbr::remote {

Clients::Clients(Wire& wire, Inbox& inbox, Tokens tokens, size_t most_clients, HandOver hand_over,
                 OwnViewRules own_views)
    : wire_(wire),
      inbox_(inbox),
      tokens_(std::move(tokens)),
      most_clients_(most_clients),
      hand_over_(hand_over),
      own_views_(own_views) {}

void Clients::opened(ClientId client) {
    const std::lock_guard lock(mutex_);
    clients_[client];
}

void Clients::closed(ClientId client) {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(client);
    if (found == clients_.end()) return;
    const ViewId view = found->second.view;
    const bool was_admitted = found->second.admitted;
    clients_.erase(found);
    if (view != shared_view) groups_.erase(view);
    if (groups_[shared_view].controller == client)
        leave_control(client);
    else if (was_admitted)
        tell_control();
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
    if (controls && !groups_[shared_view].controller) return give_control(id);
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
    if (const auto* wish = std::get_if<OwnView>(&message)) return switch_view(id, client, *wish, now);
    const auto* act = std::get_if<Act>(&message);
    if (act && act->what == Act::What::take_control) return take_control(id, client, now);
    if (const std::string why = refusal(id, client, message); !why.empty()) return refuse(id, why);
    if (act && act->what == Act::What::leave_control) {
        if (client.view == shared_view) leave_control(id);
        return;
    }
    if (!std::holds_alternative<Resize>(message)) groups_[client.view].last_input_s = now;
    inbox_.add({id, std::move(message), now, client.view});
}

std::string Clients::refusal(ClientId id, const Client& client, const ClientMessage& message) const {
    if (group(client.view)->controller != id) return "Somebody else controls this view";
    if (client.view == shared_view) return {};
    const auto* widget = std::get_if<SetWidget>(&message);
    if (std::holds_alternative<ShowObject>(message) || std::holds_alternative<Animate>(message) ||
        (widget && !widget->tool))
        return "What all see is changed in the shared view";
    const bool costs = std::holds_alternative<Shot>(message) || widget;
    return costs && !client.may_control ? "This link is for watching only" : "";
}

void Clients::refuse(ClientId id, const std::string& why) {
    wire_.send(id, std::make_shared<const std::string>(notice_text(why, true)));
}

std::string Clients::own_view_refusal(const Client& client) const {
    if (own_views_.most == 0) return "Own views are off here";
    if (!client.may_control && !own_views_.for_watchers) return "This link is for watching only";
    if (groups_.size() > own_views_.most)
        return fmt::format("{} of {} views of clients' own are taken", own_views_.most, own_views_.most);
    return {};
}

void Clients::switch_view(ClientId id, Client& client, const OwnView& wish, double now) {
    if (wish.own == (client.view != shared_view)) return;
    if (wish.own) {
        if (const std::string why = own_view_refusal(client); !why.empty()) return refuse(id, why);
        const bool had_control = groups_[shared_view].controller == id;
        client.own_size = wish.size;
        look_at(client, free_view());
        groups_[client.view].controller = id;
        if (had_control) leave_control(id);
    } else {
        groups_.erase(client.view);
        look_at(client, shared_view);
    }
    inbox_.add({id, wish, now, client.view});
    if (!wish.own && client.may_control && !groups_[shared_view].controller) return give_control(id);
    tell_control();
    pump(id, client, now);
}

/// What is on its way is answered still; the next picture is another view's.
void Clients::look_at(Client& client, ViewId view) {
    client.view = view;
    client.frame = 0;
    client.done = true;
    client.seat.leave();
}

ViewId Clients::free_view() {
    do ++last_view_;
    while (groups_.contains(last_view_));
    return last_view_;
}

const Clients::Group* Clients::group(ViewId view) const {
    const auto found = groups_.find(view);
    return found == groups_.end() ? nullptr : &found->second;
}

std::vector<OwnViewOf> Clients::own_views() const {
    const std::lock_guard lock(mutex_);
    std::vector<OwnViewOf> views;
    for (const auto& [id, client] : clients_)
        if (client.view != shared_view) views.push_back({client.view, !client.may_control, client.own_size});
    return views;
}

void Clients::ack(ClientId id, Client& client, const Ack& ack, double now) {
    const size_t before = client.flow.count();
    // The wire's thread was late twice: when it wrote, and when it read the answer.
    client.flow.drawn(ack.frame, ack.chunk, now, {ack.busy_s, 2 * wire_.lag_s()});
    Group& group = groups_[client.view];
    const bool counts = client.flow.count() != before && group.controller == id;
    if (counts && group.newest && group.newest->moving) group.quality.drawn(client.flow.queued_s(), now);
    pump(id, client, now);
    inbox_.wake();
}

void Clients::take_control(ClientId id, Client& client, double now) {
    const Group& group = groups_[client.view];
    if (group.controller == id) return;
    const bool is_free =
        hand_over_ == HandOver::at_once || !group.controller || now - group.last_input_s > idle_control_s;
    if (client.may_control && is_free) return give_control(id);
    const std::string why =
        client.may_control ? "Who controls this view is using it" : "This link is for watching only";
    refuse(id, why);
    if (client.may_control)
        wire_.send(*group.controller, std::make_shared<const std::string>(
                                          notice_text("Somebody asks for control of this view", false)));
}

/// The next in the order in which they came follows.
void Clients::leave_control(ClientId id) {
    groups_[shared_view].controller.reset();
    for (auto& [other, client] : clients_)
        if (other != id && client.admitted && client.may_control && client.view == shared_view)
            return give_control(other);
    tell_control();
}

void Clients::give_control(ClientId id) {
    Group& group = groups_[shared_view];
    group.controller = id;
    group.last_input_s = -1e9;
    group.quality = {};
    // Held buttons and keys of who had it before are released.
    Input released;
    released.event.kind = app::InputEvent::Kind::focus_lost;
    inbox_.add({id, released, now_seconds()});
    tell_control();
    pump(id, clients_[id], now_seconds());
}

void Clients::tell_control() {
    for (const auto& [id, client] : clients_) {
        if (!client.admitted) continue;
        const std::optional<ClientId>& controller = group(client.view)->controller;
        ControlReport report{controller == id, controller.has_value(), client.may_control, admitted()};
        report.view = client.view;
        report.may_have_own = own_views_.most > 0 && (client.may_control || own_views_.for_watchers);
        wire_.send(id, std::make_shared<const std::string>(control_text(report)));
    }
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

VideoDemand Clients::demand(ViewId view) {
    const std::lock_guard lock(mutex_);
    const auto found = groups_.find(view);
    if (found == groups_.end()) return {};
    double& last_key_s = found->second.last_key_s;
    const double now = now_seconds();
    const bool may_begin = offers_video_ && now - last_key_s >= key_wait_s;
    VideoDemand demand;
    for (const auto& [id, client] : clients_) {
        if (!client.looks_at(view)) continue;
        if (offers_video_ && client.seat.is_in())
            demand.video = true;
        else if (client.flow.has_room())
            (may_begin && client.seat.wants_key(now) ? demand.key : demand.jpeg) = true;
    }
    if (demand.key) last_key_s = now;
    demand.video |= demand.key;
    return demand;
}

bool Clients::publish(ViewId view, Picture picture) {
    const uint32_t frame = picture.header.frame;
    return take_newest(view, {frame, false, std::move(picture), {}});
}

bool Clients::publish(ViewId view, MovingPicture picture) {
    const FrameHeader& header = picture.video ? picture.video->picture.header : picture.jpeg->header;
    const uint32_t frame = header.frame;
    return take_newest(view, {frame, true, std::move(picture.jpeg), std::move(picture.video)});
}

bool Clients::take_newest(ViewId view, Newest newest) {
    const std::lock_guard lock(mutex_);
    const auto found = groups_.find(view);
    if (found == groups_.end()) return false;
    std::optional<Newest>& known = found->second.newest;
    if (known && newest.frame <= known->frame) return false;
    known = std::move(newest);
    const double now = now_seconds();
    for (auto& [id, client] : clients_)
        if (client.view == view) pump(id, client, now);
    return true;
}

void Clients::pump(ClientId id, Client& client, double now) {
    if (!client.admitted) return;
    pump_shot(id, client, now);
    const std::optional<Newest>& newest = groups_[client.view].newest;
    if (!newest || client.paused) return;
    if (newest->moving) return pump_moving(id, client, now);
    if (client.frame != newest->frame) {
        client.frame = newest->frame;
        client.from = 0;
        client.chunk = 0;
        client.done = false;
    }
    while (!client.done && client.flow.has_chunk_room()) {
        send_part(id, client, *newest->picture, client.from, client.chunk, false, now);
        client.done = client.from == newest->picture->bytes->size();
    }
}

/// As a whole: the next one replaces it.
void Clients::pump_moving(ClientId id, Client& client, double now) {
    Group& group = groups_[client.view];
    if (client.frame == group.newest->frame || !client.flow.has_room()) return;
    client.frame = group.newest->frame;
    client.done = true;
    const Picture* picture = version_for(client, now);
    if (!picture) return;
    if (group.controller == id) group.quality.use_video(picture->header.codec == Codec::h264);
    size_t from = 0;
    uint16_t chunk = 0;
    send_part(id, client, *picture, from, chunk, true, now);
}

/// Null: it can do nothing with any, and waits for the next.
const Picture* Clients::version_for(Client& client, double now) {
    const Newest& newest = *groups_[client.view].newest;
    const auto& video = newest.video;
    if (video && client.seat.can_take(video->mark)) {
        client.seat.took(video->mark, now);
        return &video->picture;
    }
    if (video) client.seat.missed(now);
    return newest.picture ? &*newest.picture : nullptr;
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

void Clients::broadcast(ViewId view, const std::string& text, bool for_watchers) {
    const auto shared = std::make_shared<const std::string>(text);
    const std::lock_guard lock(mutex_);
    for (const auto& [id, client] : clients_)
        if (client.admitted && client.view == view && (for_watchers || client.may_control))
            wire_.send(id, shared);
}

void Clients::tell(ClientId id, const std::string& text, bool for_watchers) {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end() || !(for_watchers || found->second.may_control)) return;
    wire_.send(id, std::make_shared<const std::string>(text));
}

std::vector<ClientState> Clients::states() const {
    const std::lock_guard lock(mutex_);
    std::vector<ClientState> states;
    for (const auto& [id, client] : clients_)
        if (client.admitted)
            states.push_back({id, client.view, group(client.view)->controller == id, !client.may_control,
                              client.paused, client.flow.latency_s()});
    return states;
}

bool Clients::anybody() const {
    const std::lock_guard lock(mutex_);
    return admitted() > 0;
}

bool Clients::is_there(ClientId client) const {
    const std::lock_guard lock(mutex_);
    return clients_.contains(client);
}

bool Clients::anybody_looks(ViewId view) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(clients_, [&](const auto& each) { return each.second.looks_at(view); });
}

const Clients::Client* Clients::looking_controller(const Group& group) const {
    if (!group.controller) return nullptr;
    const Client& client = clients_.at(*group.controller);
    return client.paused || client.flow.waits_s(now_seconds()) > silent_s ? nullptr : &client;
}

bool Clients::has_room(ViewId view, size_t coming) const {
    const std::lock_guard lock(mutex_);
    const Group* const group = this->group(view);
    if (!group) return true;
    if (const Client* controller = looking_controller(*group)) return controller->flow.has_room(coming);
    return std::ranges::any_of(clients_, [&](const auto& each) {
        return each.second.looks_at(view) && each.second.flow.has_room(coming);
    });
}

bool Clients::has_delivered(ViewId view) const {
    const std::lock_guard lock(mutex_);
    const Group* const group = this->group(view);
    if (!group || !group->newest) return true;
    const auto has = [&](const Client& client) {
        return client.frame == group->newest->frame && client.done && client.flow.count() == 0;
    };
    if (const Client* controller = looking_controller(*group)) return has(*controller);
    return std::ranges::any_of(
        clients_, [&](const auto& each) { return each.second.view == view && has(each.second); });
}

WireQuality Clients::quality(ViewId view) const {
    const std::lock_guard lock(mutex_);
    const Group* const group = this->group(view);
    return group ? group->quality : WireQuality();
}

}  // namespace easypbr::remote
