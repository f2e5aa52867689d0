// View: what some clients see, through one camera.
#pragma once

#include <memory>
#include <string>

#include "easypbr/app/live_drawing.h"
#include "easypbr/remote/describe.h"
#include "easypbr/remote/encoder.h"
#include "easypbr/remote/inbox.h"
#include "easypbr/remote/view_clients.h"

namespace easypbr {
class Animations;
}

namespace easypbr::remote {

class ServedFiles;

/// Pictures of a scene that a program may change meanwhile, with settings of its own. While something moves
/// they are drawn quickly and sent as video or JPEG; at rest as JPEG of quality 95 while they are refined,
/// and at the end as PNG, Session::render()'s picture bit for bit. Used by the thread of Views alone.
class View {
  public:
    /// The shared one. `inbox` and what `clients` stands for must outlive it. Clients may open `files`; null:
    /// none.
    View(const Scene& scene, const Settings& settings, Inbox& inbox, ViewClients clients,
         std::unique_ptr<ServedFiles> files);
    /// A client's own: it begins with camera and settings of the shared one, which must outlive it, and draws
    /// the same scene by the same device.
    View(View& shared, Inbox& inbox, ViewClients clients, const OwnViewOf& own);
    ~View();
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    /// Gives up what is recorded and forgets the program's panels.
    void end();

    /// Takes what clients have asked for, draws what is to be drawn and tells what has changed. Returns how
    /// many seconds the next step may be waited for, 0 where there is more to do.
    double step(bool refines);
    /// Its pictures should come quickly, and somebody sees them.
    bool is_quick() const;
    /// Somebody looks at a picture at rest that is not drawn to its end.
    bool wants_refinement() const;

    /// What the program has changed since the last call is changed here; what clients have changed stays.
    void take_settings(const Settings& settings);
    void add_animations(const std::string& name, const Animations& animations);
    void add_panel(const std::string& name, const app::PanelFunction& function);
    void remove_panel(const std::string& name);

    /// Moving pictures are asked for until so long after the last input or change.
    static constexpr double rest_s = 0.15;
    /// What a moving picture's drawing should take where the CPU draws: reading, encoding and the way come to
    /// it.
    static constexpr double longest_frame_s = 0.045;
    /// Stills that are drawn before others get their turn; more that wait meanwhile are refused.
    static constexpr int most_stills = 2;
    /// How often an idle view looks whether the scene is another one: so rarely that it takes 1 % of a core,
    /// within these bounds.
    static constexpr double look_s = 0.05, longest_look_s = 0.3;

  private:
    struct Own;
    bool has_orders() const { return inbox_.has_orders(clients_.view()); }
    bool waits_for_clients() const;
    /// Nothing has been asked for and nothing has changed for a second: changes are told less often.
    bool rests() const;
    void act(const std::vector<Order>& orders);
    void obey(const Order& order);
    void obey(ClientId from, const Hello& message);
    void obey(ClientId from, const Input& message);
    void obey(ClientId from, const Turn& message);
    void obey(ClientId from, const Resize& message);
    void obey(ClientId from, const OwnView& message);
    void obey(ClientId from, const SetField& message);
    void obey(ClientId from, const ShowObject& message);
    void obey(ClientId from, const Select& message);
    void obey(ClientId from, const PickAt& message);
    void obey(ClientId from, const SetChannel& message);
    void obey(ClientId from, const Shot& message);
    void obey(ClientId from, const SetCamera& message);
    void obey(ClientId from, const SetWidget& message);
    void obey(ClientId from, const Animate& message);
    void obey(ClientId from, const Act& message);
    // What the network's side has taken already.
    void obey(ClientId, const Ack&) {}
    void obey(ClientId, const Pause&) {}
    void obey(ClientId, const Decodes&) {}

    void draw(bool refines);
    void send_picture(bool drew);
    void send_moving();
    void send_still(bool exact);
    FrameHeader header(FrameKind kind, Codec codec);
    void send_video();
    void tell_changes();
    void tell_settings();
    void tell_everything(ClientId client);
    void tell_notices();
    bool is_moving() const;

    Inbox& inbox_;
    ViewClients clients_;
    std::unique_ptr<Own> own_;
};

}  // namespace easypbr::remote
