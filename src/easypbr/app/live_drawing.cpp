#include "easypbr/app/live_drawing.h"

#include <utility>

#include "easypbr/app/camera_text.h"
#include "easypbr/app/recorder.h"
#include "easypbr/core/error.h"

namespace easypbr::app {
namespace {

using Kind = InputEvent::Kind;

}  // namespace

struct LiveDrawing::Own {
    explicit Own(Session& session) : recorder(session, clock), player(clock) {
        player.on_jump = [&](const MovedMeshes& moved) { session.replace_motion(moved); };
    }
    Clock clock;
    Recorder recorder;
    AnimationPlayer player;
};

LiveDrawing::LiveDrawing(Session& session) : LiveDrawing(session, std::make_unique<Own>(session)) {}

LiveDrawing::LiveDrawing(Session& session, std::unique_ptr<Own> own)
    : LiveDrawing(session, own->recorder, own->player) {
    own_ = std::move(own);
}

LiveDrawing::LiveDrawing(Session& session, Recorder& recorder, AnimationPlayer& player)
    : session_(session),
      player_(player),
      picture_(session),
      navigation_(session, picture_),
      edits_(session),
      files_(session, player, notifications_, edits_),
      recording_(session, recorder) {
    const auto text = std::make_shared<std::string>();
    clipboard_.read = [text] { return *text; };
    clipboard_.write = [text](const std::string& written) { *text = written; };
}

LiveDrawing::~LiveDrawing() = default;

bool LiveDrawing::update(const std::vector<InputEvent>& events, Vec2i size, double seconds) {
    if (size.minCoeff() < 1) return false;
    begin_frame(size, seconds);
    for (const InputEvent& event : events)
        if (!offer(event)) handle(event);
    const bool drew = draw();
    end_frame();
    return drew || picture_.shows_other();
}

void LiveDrawing::begin_frame(Vec2i size, double seconds) {
    seconds_ = seconds;
    if (std::exchange(size_, size) != size) {
        InputEvent event;
        event.kind = Kind::resize;
        event.size = size;
        offer_to_handlers(event);
    }
    files_.advance(seconds);
    edits_.keep_chosen();
}

void LiveDrawing::leave(const InputEvent& event) {
    if (event.kind != Kind::move) return;
    if (std::exchange(pointer_, event.position) != event.position) navigation_.point_elsewhere();
    picture_.point_at(pointer_, false);
}

bool LiveDrawing::offer(const InputEvent& event) {
    if (event.kind == Kind::leave) {
        pointer_ = {-1, -1};
        picture_.point_at(pointer_, false);
    }
    if (event.kind == Kind::move) {
        if (std::exchange(pointer_, event.position) != event.position) navigation_.point_elsewhere();
        picture_.point_at(pointer_, true);
    }
    return offer_to_handlers(event);
}

bool LiveDrawing::offer_to_handlers(const InputEvent& event) {
    if (handlers_.empty()) return false;
    bool taken = false;
    edits_.as_program([&] { taken = handlers_.offer(event); });
    return taken;
}

std::string LiveDrawing::call_panel(const std::string& name, Widgets& widgets) {
    std::string error;
    edits_.as_program([&] { error = panels_.call(name, widgets); });
    return error;
}

void LiveDrawing::handle(const InputEvent& event) {
    if (event.kind == Kind::drop) return open(event.paths);
    if (!shortcut(event)) move_camera(event);
}

void LiveDrawing::open(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) try {
            files_.open(path);
        } catch (const Error& error) {
            notifications_.add(error.what(), true);
        }
}

bool LiveDrawing::shortcut(const InputEvent& event) {
    if (event.kind != Kind::key_down) return false;
    if (event.control) return control_shortcut(event), true;
    if (event.repeat) return false;
    if (event.key == key::escape) return wishes_.close = true;
    if (event.key != 'K') return false;
    if (!handlers_.guarded([&] { add_path_key(); })) handlers_.forget_failure();
    return true;
}

void LiveDrawing::control_shortcut(const InputEvent& event) {
    const int key = event.key;
    try {
        if (key == 'Z' && !event.shift) edits_.undo();
        if (key == 'Y' || (key == 'Z' && event.shift)) edits_.redo();
        if (event.repeat) return;
        if (key == 'S') wishes_.save = true;
        if (key == 'C') {
            clipboard_.write(camera_text(session_, size_));
            notifications_.add("The camera is on the clipboard");
        }
        if (key == 'V') apply_camera_text(clipboard_.read(), session_.settings());
    } catch (const Error& error) {
        notifications_.add(error.what(), true);
    }
}

void LiveDrawing::move_camera(const InputEvent& event) {
    try {
        if (const std::optional<Vec2d> clicked = navigation_.handle(event, size_)) {
            const std::optional<Pick> pick = picture_.surfaces(size_).at(*clicked);
            selection_ = {pick ? pick->object : "", "", pick};
        }
    } catch (const Error& error) {
        notifications_.add(error.what(), true);
    }
}

void LiveDrawing::add_path_key() {
    // After the chosen key, so that a path can be refined in its middle.
    const size_t count = path_.editor.keys().size();
    const size_t at = path_.key && *path_.key < count ? *path_.key + 1 : count;
    path_.editor.insert(at, session_.camera());
    path_.key = at;
}

void LiveDrawing::set_turntable() {
    constexpr double turn_s = 8;
    path_.editor.set(turntable(session_, turn_s, player_));
    path_.key.reset();
}

bool LiveDrawing::is_moving(const LiveNeeds& needs) const {
    return needs.moving || navigation_.is_moving() || path_.editor.is_playing();
}

bool LiveDrawing::is_busy() const {
    const bool refines = !picture_.has_failed() && !picture_.is_complete();
    return refines || navigation_.is_active() || path_.editor.is_playing() || recording_.is_path();
}

LiveShot LiveDrawing::shot(const LiveNeeds& needs) {
    LiveShot shot{size_, channel, is_moving(needs), needs.resolution, needs.pass_times, needs.surfaces};
    shot.longest_s = needs.longest_s;
    shot.refines = needs.refines;
    shot.interrupt = needs.interrupt;
    shot.motion = [this](const Camera& now) { return shown_motion(now); };
    shot.motion_key = {player_.speed(), form_.fps};
    return shot;
}

bool LiveDrawing::draw(const LiveNeeds& needs) {
    try {
        navigation_.advance(seconds_, size_);
        if (std::exchange(wishes_.save, false)) files_.save_settings(settings_file, size_);
    } catch (const Error& error) {
        notifications_.add(error.what(), true);
    }
    move_along_path(seconds_);
    notifications_.advance(seconds_);
    // While a path is recorded its frames are shown.
    if (recording_.is_path() || !picture_.draw(shot(needs))) return false;
    if (picture_.has_failed() && !session_.scene().names().empty())
        notifications_.add(picture_.failure(), true);
    return true;
}

void LiveDrawing::draw_finished(const LiveNeeds& needs) {
    picture_.finish(shot(needs));
    if (needs.surfaces) picture_.surfaces(size_);
}

void LiveDrawing::end_frame(const LiveNeeds& needs, const LiveScreens& screens) {
    record(screens);
    if (!is_moving(needs) && !picture_.has_failed() && !recording_.is_path()) edits_.note();
}

}  // namespace easypbr::app
