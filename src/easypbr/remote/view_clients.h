// ViewClients: the clients of one view, as the view sees them.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "easypbr/remote/clients.h"

namespace easypbr::remote {

/// See Clients. A handle, used from any thread.
class ViewClients {
  public:
    /// `clients` must outlive it.
    ViewClients(Clients& clients, ViewId view) : clients_(&clients), view_(view) {}

    ViewId view() const { return view_; }
    uint32_t next_frame() const { return clients_->next_frame(); }
    void offer_video(bool offered) const { clients_->offer_video(offered); }
    VideoDemand demand() const { return clients_->demand(view_); }
    bool publish(Picture picture) const { return clients_->publish(view_, std::move(picture)); }
    bool publish(MovingPicture picture) const { return clients_->publish(view_, std::move(picture)); }
    void send_shot(ClientId client, Picture picture) const {
        clients_->send_shot(client, std::move(picture));
    }
    void broadcast(const std::string& text, bool for_watchers = true) const {
        clients_->broadcast(view_, text, for_watchers);
    }
    void tell(ClientId client, const std::string& text, bool for_watchers = true) const {
        clients_->tell(client, text, for_watchers);
    }
    bool is_there(ClientId client) const { return clients_->is_there(client); }
    bool anybody_looks() const { return clients_->anybody_looks(view_); }
    bool has_room(size_t coming) const { return clients_->has_room(view_, coming); }
    bool has_delivered() const { return clients_->has_delivered(view_); }
    WireQuality quality() const { return clients_->quality(view_); }
    /// Who controls the view; none: nobody.
    std::optional<ClientState> controller() const {
        for (const ClientState& state : clients_->states())
            if (state.view == view_ && state.controls) return state;
        return {};
    }

  private:
    Clients* clients_;
    ViewId view_;
};

}  // namespace easypbr::remote
