#include "easypbr/remote/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/app/camera_text.h"
#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/remote/view_state.h"
#include "easypbr/scene/animation.h"

namespace easypbr::remote {

View::View(const Scene& scene, const Settings& settings, Inbox& inbox, ViewClients clients,
           std::unique_ptr<ServedFiles> files)
    : inbox_(inbox),
      clients_(clients),
      own_(std::make_unique<Own>(scene, settings, clients, std::move(files))) {}

View::View(View& shared, Inbox& inbox, ViewClients clients, const OwnViewOf& own)
    : inbox_(inbox), clients_(clients), own_(std::make_unique<Own>(*shared.own_, clients, own)) {}

View::~View() {
    end();
}

void View::end() {
    own_->live.panels() = {};
    own_->live.stop_recording();
    own_->videos.clear();
}

bool View::waits_for_clients() const {
    return (has_orders() || is_moving()) && !clients_.has_room(own_->moving.pending());
}

double View::step(bool refines) {
    Own& own = *own_;
    if (!clients_.anybody_looks() && !own.live.recording().is_running()) {
        act(inbox_.take(clients_.view()));
        tell_changes();
        return 60;
    }
    // What the line holds back is drawn later, with the newest camera.
    if (waits_for_clients()) return 0.1;
    const double begun = now_seconds();
    act(inbox_.take(clients_.view()));
    draw(refines);
    tell_changes();
    const bool is_held = !refines && wants_refinement();
    if ((own.live.is_busy() && !is_held) || has_orders()) return 0;
    const bool waits = is_moving() || own.owes_still || own.live.recording().is_running();
    // Input wakes it at once: what is looked for is what the program changes.
    return waits ? 0.01 : std::clamp(100 * (now_seconds() - begun), look_s, longest_look_s);
}

bool View::is_quick() const {
    return clients_.anybody_looks() && (is_moving() || own_->live.navigation().is_moving());
}

bool View::wants_refinement() const {
    const app::LivePicture& picture = own_->live.picture();
    return clients_.anybody_looks() && !is_quick() && !picture.has_failed() && !picture.is_complete();
}

bool View::rests() const {
    return now_seconds() - std::max(own_->acted_s, own_->last_change_s) > 1;
}

bool View::is_moving() const {
    return now_seconds() - own_->last_change_s < rest_s || own_->scene_player.is_playing() ||
           own_->live.path().editor.is_playing() || own_->live.recording().is_path();
}

void View::act(const std::vector<Order>& orders) {
    Own& own = *own_;
    const double now = now_seconds();
    own.live.begin_frame(own.size, std::min(now - std::exchange(own.last_frame_s, now), 0.1));
    int stills = 0;
    for (const Order& order : orders) try {
            if (std::holds_alternative<Shot>(order.message) && ++stills > most_stills)
                throw ArgumentError(fmt::format("stills: at most {} wait at a time", most_stills));
            obey(order);
        } catch (const Error& error) {
            clients_.tell(order.from, notice_text(error.what(), true));
            own.told.clear();  // What was not taken is shown as it is.
        }
}

void View::obey(const Order& order) {
    own_->waits_since_s = order.arrived_s;
    own_->acted_s = now_seconds();
    std::visit([&](const auto& message) { obey(order.from, message); }, order.message);
}

void View::draw(bool refines) {
    Own& own = *own_;
    own.clock.tick();
    const bool moving = is_moving();
    app::LiveNeeds needs;
    needs.moving = moving;
    needs.resolution = clients_.quality().resolution();
    needs.longest_s = longest_frame_s;
    needs.refines = refines;
    needs.interrupt = [this] { return inbox_.has_presses(clients_.view()); };
    const uint64_t pictures = own.live.picture().statistics().pictures;
    const bool drew = own.live.draw(needs);
    own.live.end_frame(needs);
    // Of a scene that goes on changing the next pictures shall come quickly.
    const bool is_new = own.live.picture().statistics().pictures != pictures;
    if (is_new && !moving && own.has_drawn) own.last_change_s = now_seconds();
    own.has_drawn |= is_new;
    send_picture(drew || own.live.picture().shows_other());
    send_video();
    tell_notices();
}

void View::send_picture(bool drew) {
    Own& own = *own_;
    const app::LivePicture& picture = own.live.picture();
    if (picture.has_failed() || !picture.has_image()) return;
    if (drew && picture.statistics().frames <= 1) own.owes_still = true;
    own.has_news |= drew;
    if (is_moving() || own.live.navigation().is_moving()) {
        if (drew) send_moving();
        return;
    }
    if (picture.is_complete()) {
        if (own.owes_still) send_still(true);
        return;
    }
    const int frames = picture.statistics().frames;
    const bool is_step = (frames & (frames - 1)) == 0;
    const bool in_time = now_seconds() - own.last_still_s >= rest_s;
    if (own.has_news && is_step && in_time && !own.stills.is_busy() && clients_.has_delivered())
        send_still(false);
}

FrameHeader View::header(FrameKind kind, Codec codec) {
    Own& own = *own_;
    const app::LiveStatistics& statistics = own.live.picture().statistics();
    const double now = now_seconds();
    FrameHeader header;
    header.kind = kind;
    header.codec = codec;
    header.frame = clients_.next_frame();
    header.input = own.input;
    header.view = clients_.view();
    header.refined = uint16_t(std::min(statistics.frames, 65535));
    header.total = uint16_t(std::min(statistics.total, 65535));
    header.draw_us = uint32_t(statistics.frame_seconds * 1e6);
    const double since = std::exchange(own.waits_since_s, 0);
    header.wait_us = since > 0 ? uint32_t(std::min(now - since, 4000.0) * 1e6) : 0;
    return header;
}

void View::send_moving() {
    Own& own = *own_;
    const WireQuality quality = clients_.quality();
    own.moving.add({own.live.picture().image(), header(FrameKind::moving, Codec::jpeg),
                    quality.jpeg_quality(), quality.video_rate(double(own.size.x()) * own.size.y())});
}

void View::send_still(bool exact) {
    Own& own = *own_;
    own.last_still_s = now_seconds();
    own.has_news = false;
    FrameHeader head = header(FrameKind::still, exact ? Codec::png : Codec::jpeg);
    if (exact) head.flags |= FrameHeader::exact;
    own.owes_still = !exact;
    own.stills.add({own.live.picture().image(), head, 95});
}

/// To who asked for it.
void View::send_video() {
    Own& own = *own_;
    const bool is_new = own.videos.advance();
    if (std::exchange(own.tool_state.wants_video, false) || is_new) try {
            clients_.send_shot(own.tool_user, own.videos.fetch(clients_.next_frame()));
        } catch (const Error& error) {
            own.live.notifications().add(error.what(), true);
        }
}

void View::tell_notices() {
    Own& own = *own_;
    const app::Notifications& notices = own.live.notifications();
    if (std::exchange(own.notices, notices.revision()) == notices.revision()) return;
    for (const app::Notification& notice : notices.list()) {
        // Their time left goes down: one that is as new as can be was not told yet.
        const double whole = notice.is_error ? 12.0 : 5.0;
        if (notice.seconds_left >= whole)
            clients_.broadcast(notice_text(own.videos.plain(notice.text), notice.is_error));
    }
}

void View::tell_changes() {
    Own& own = *own_;
    const double now = now_seconds();
    // At rest only what leaves the picture as it is can have changed.
    if (now - own.told_s < (rests() ? 0.5 : 0.1) && !own.told.empty()) return;
    own.told_s = now;
    tell_settings();
    const auto tell = [&](std::string& last, std::string text) {
        if (last == text) return;
        last = std::move(text);
        clients_.broadcast(last);
    };
    tell(own.told_camera, own.camera_message());
    tell(own.told_scene, own.scene_message());
    tell(own.told_animation, own.animation_message());
    tell(own.told_panels, panels_text(own.live.panels(), own.panel_memories));
    for (const ToolText& news : own.tools.news()) clients_.broadcast(news.text, news.for_watchers);
    tell_notices();
    tell(own.told_statistics, own.statistics_message(clients_));
}

void View::tell_settings() {
    Own& own = *own_;
    const Settings& settings = own.session.settings();
    // Texts of all fields are the larger part of what a view at rest would cost.
    if (!own.told.empty() && are_equal(own.told_settings, settings)) return;
    const FieldTexts texts = texts_of(settings);
    if (const FieldTexts news = changed(own.told, texts); !news.empty())
        clients_.broadcast(settings_text(news));
    own.told = texts;
    own.told_settings = settings;
}

void View::tell_everything(ClientId client) {
    Own& own = *own_;
    clients_.tell(client, settings_text(texts_of(own.session.settings())));
    for (const std::string& text : {own.camera_message(), own.scene_message(), own.animation_message(),
                                    own.told_panels, own.statistics_message(clients_)})
        if (!text.empty()) clients_.tell(client, text);
    for (const ToolText& told : own.tools.told()) clients_.tell(client, told.text, told.for_watchers);
}

void View::take_settings(const Settings& settings) {
    Own& own = *own_;
    const auto changed = app::changed_choices(own.given, settings);
    own.given = settings;
    if (changed.empty()) return;
    own.live.edits().change_settings([&](Settings& all) {
        for (const auto& [name, value] : changed) set(all, name, value);
    });
}

void View::add_animations(const std::string& name, const Animations& animations) {
    own_->player.add(name, animations, own_->session.scene());
}

void View::add_panel(const std::string& name, const app::PanelFunction& function) {
    own_->live.panels().add(name, function);
    own_->panel_memories.erase(name);
}

void View::remove_panel(const std::string& name) {
    if (own_->live.panels().revision(name) > 0) own_->live.panels().remove(name);
    own_->panel_memories.erase(name);
}

}  // namespace easypbr::remote
