// What a view does for its clients, message by message.
#include <fmt/format.h>

#include <utility>

#include "easypbr/app/camera_text.h"
#include "easypbr/app/channels.h"
#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/remote/view_state.h"
#include "easypbr/render/pipeline/layers.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::remote {

View::Own::Own(const Scene& scene, const Settings& settings, ViewClients clients,
               std::unique_ptr<ServedFiles> given_files)
    : session(scene),
      scene_player(player),
      first(settings),
      given(settings),
      files(std::move(given_files)),
      tools(tool_state, true),
      moving_pictures(clients),
      moving([this](EncodeJob job) { moving_pictures.code(std::move(job)); }),
      stills([clients](EncodeJob job) { clients.publish(encode(std::move(job))); }) {
    session.replace_settings(settings);
    clock.on_tick = [this] { player.update(); };
    clock.on_set = [this] { player.follow_set_clock(); };
    player.on_jump = [this](const MovedMeshes& moved) { session.replace_motion(moved); };
}

View::Own::Own(Own& shared, ViewClients clients, const OwnViewOf& own)
    : session(shared.session.beside()),
      scene_player(shared.player),
      first(shared.first),
      given(shared.given),
      size(own.size),
      tools(tool_state, false),
      moving_pictures(clients),
      moving([this](EncodeJob job) { moving_pictures.code(std::move(job)); }),
      stills([clients](EncodeJob job) { clients.publish(encode(std::move(job))); }) {
    live.channel = shared.live.channel;
}

void View::Own::keep_drawable(const Settings& before) {
    if (session.scene().names().empty()) return;
    try {
        session.resolve(size);
    } catch (const Error&) {
        const Settings changed = std::exchange(session.settings(), before);
        try {
            session.resolve(size);
        } catch (const Error&) {
            // It was no better before: a change may mend one of several things.
            session.settings() = changed;
            return;
        }
        throw;
    }
}

std::string View::Own::camera_message() {
    if (session.scene().names().empty()) return camera = {}, remote::camera_message({});
    try {
        // The camera is a part of the picture; what of it is written depends on the settings too.
        const uint64_t version = session.picture_version(size);
        const bool is_known = camera.version == version && are_equal(camera.settings, session.settings());
        if (!is_known) camera = {version, session.settings(), written_camera()};
        return camera.message;
    } catch (const Error&) {
        camera = {};  // Nothing can be drawn; the settings may give a camera all the same.
    }
    try {
        return written_camera();
    } catch (const Error&) {
        return told_camera;
    }
}

std::string View::Own::written_camera() {
    return remote::camera_message(app::camera_text(session, size));
}

std::string View::Own::scene_message() {
    return scene_text(session.scene(), live.selection().object, live.channel);
}

std::string View::Own::animation_message() const {
    if (player.empty()) return animation_text({}, 0, false, 0, 0, 1);
    return animation_text(player.names(), player.current(), player.is_playing(), player.shown_time(),
                          player.duration_s(), player.speed());
}

std::string View::Own::statistics_message(const ViewClients& clients) {
    StatisticsReport report;
    report.drawing = live.picture().statistics();
    report.share = clients.quality().share();
    report.software = session.context_info().software;
    if (const auto client = clients.controller()) report.latency_s = client->latency_s;
    return statistics_text(report);
}

void View::obey(ClientId from, const Hello& message) {
    const auto controller = clients_.controller();
    if (controller && controller->id == from) own_->size = message.size;
    tell_everything(from);
}

void View::obey(ClientId from, const OwnView&) {
    tell_everything(from);
}

void View::obey(ClientId, const Input& message) {
    Own& own = *own_;
    using Kind = app::InputEvent::Kind;
    const Kind kind = message.event.kind;
    if (kind != Kind::focus_lost || message.id != 0) own.input = message.id;
    // A pointer that only passes over the picture moves nothing.
    const bool moves = kind == Kind::scroll || (kind == Kind::move && own.live.navigation().is_active());
    if (moves) own.last_change_s = now_seconds();
    if (!own.live.offer(message.event)) own.live.handle(message.event);
}

void View::obey(ClientId, const Turn& message) {
    Own& own = *own_;
    own.input = message.id;
    own.last_change_s = now_seconds();
    if (own.session.scene().names().empty()) return;
    const app::ViewPoint view = own.session.view_point(own.size);
    const Vec3d up = own.session.up();
    own.session.set_view_point(app::orbited(view, up, message.right_deg, message.up_deg));
}

void View::obey(ClientId, const Resize& message) {
    own_->size = message.size;
}

void View::obey(ClientId, const SetField& message) {
    Own& own = *own_;
    const Field& field = easypbr::field(message.name);
    if (!is_open(field)) throw ArgumentError(fmt::format("{}: only the program may set this", field.name));
    const Value value = parse_value(field, message.value);
    check_client_value(field, value);
    const Settings before = own.session.settings();
    set(own.session.settings(), field.name, value);
    own.keep_drawable(before);
    own.last_change_s = now_seconds();
}

void View::obey(ClientId, const ShowObject& message) {
    Own& own = *own_;
    if (!app::node_named(own.session.scene(), message.object))
        throw NameError(fmt::format("there is no object '{}'", message.object));
    own.live.edits().change_look(message.object, "style.visible", {message.visible});
}

void View::obey(ClientId, const Select& message) {
    own_->live.selection().object = message.object;
}

void View::obey(ClientId from, const PickAt& message) {
    Own& own = *own_;
    const auto pick = own.live.pick(message.pixel);
    own.live.selection() = {pick ? pick->object : "", "", pick};
    clients_.tell(from, pick_text(message.id, pick, own.session.scene()));
}

void View::obey(ClientId, const SetChannel& message) {
    if (app::is_layer(message.name)) render::layer_named(message.name);
    own_->live.channel = message.name;
}

void View::obey(ClientId from, const Shot& message) {
    Own& own = *own_;
    if (!clients_.is_there(from)) return;
    Image image;
    try {
        const InterruptScope scope([&] { return !clients_.is_there(from); }, true);
        image = own.session.render({message.size, own.session.settings().image.samples});
    } catch (const Interrupted&) {
        check_interrupt();  // Who waits outside is told.
        return;
    }
    FrameHeader header;
    header.kind = FrameKind::shot;
    header.codec = Codec::png;
    header.flags = FrameHeader::exact;
    header.frame = clients_.next_frame();
    header.input = message.id;
    header.view = clients_.view();
    clients_.send_shot(from, encode({image, header, 95}));
}

void View::obey(ClientId, const SetCamera& message) {
    // What is inferred follows from the first view, not from where a link looks.
    if (!own_->has_drawn) {
        own_->live.begin_frame(own_->size, 0);
        draw(false);
    }
    const Settings before = own_->session.settings();
    app::apply_camera_text(message.text, own_->session.settings());
    own_->keep_drawable(before);
    own_->last_change_s = now_seconds();
}

void View::obey(ClientId from, const SetWidget& message) {
    Own& own = *own_;
    own.told_s = -1;  // It is shown at once.
    if (message.tool) {
        own.tool_user = from;
        return own.tools.edit(message);
    }
    if (own.live.panels().revision(message.panel) == 0)
        throw ArgumentError(fmt::format("there is no panel '{}'", message.panel));
    own.panel_memories[message.panel].edits[{message.name, message.use}] = message.value;
}

void View::obey(ClientId, const Animate& message) {
    app::AnimationPlayer& player = own_->player;
    if (player.empty()) throw ArgumentError("there is no animation");
    if (message.number != player.current()) player.play(size_t(message.number));
    player.set_speed(message.speed);
    player.seek(message.time_s);
    if (message.plays)
        player.resume();
    else
        player.pause();
}

void View::obey(ClientId, const Act& message) {
    using What = Act::What;
    Own& own = *own_;
    if (message.what == What::fit) own.live.navigation().ask_fit();
    if (message.what == What::undo) own.live.edits().undo();
    if (message.what == What::redo) own.live.edits().redo();
    if (message.what != What::reset) return;
    own.session.replace_settings(own.first);
    own.has_drawn = false;
}

}  // namespace easypbr::remote
