#include "easypbr/gui/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/gl/context.h"
#include "easypbr/gui/panels.h"

namespace easypbr::gui {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;

/// How often the panels of users are called while nothing happens.
constexpr double panels_seconds = 0.05;
/// Pictures after which a screenshot waits no longer for one that stays.
constexpr uint64_t most_changes = 8;
/// Frames of the GUI after which a screenshot of a picture that stays waits no longer.
constexpr int most_gui_frames = 16;
/// Of the panels, of the screen's scale times panel_scale: fonts beyond are larger than textures may be.
constexpr float least_scale = 0.25f, most_scale = 8;

void check_scale(const char* what, float scale) {
    if (!(scale >= least_panel_scale && scale <= most_panel_scale))
        throw ArgumentError(
            fmt::format("{}: expected {} to {}, got {}", what, least_panel_scale, most_panel_scale, scale));
}

}  // namespace

LiveView::LiveView(app::Session& session) : live_(session) {
    add_menu();
}

LiveView::LiveView(app::Session& session, app::Recorder& recorder, app::AnimationPlayer& player)
    : live_(session, recorder, player) {
    add_menu();
}

void LiveView::add_menu() {
    state_.own_menu = [this] {
        user_panels_.menu(live_.panels());
        images_.menu();
    };
}

void LiveView::add_panel(const std::string& name, app::PanelFunction function) {
    live_.panels().add(name, std::move(function));
    touch();
}

void LiveView::remove_panel(const std::string& name) {
    live_.panels().remove(name);
    touch();
}

void LiveView::show_image(const std::string& name, Image image, const ImageLook& look) {
    images_.show(name, std::move(image), look);
    touch();
}

void LiveView::remove_image(const std::string& name) {
    images_.remove(name);
    touch();
}

void LiveView::stop_recording() {
    live_.stop_recording();
    touch();
}

void LiveView::set_panel_scale(float scale) {
    check_scale("panel scale", scale);
    state_.screen.panel_scale = scale;
    touch();
}

bool LiveView::update(const std::vector<InputEvent>& events, Vec2i size, float scale, double seconds) {
    if (updating_)
        throw ArgumentError(
            "a panel's function or a callback draws the window that it belongs to: update(), show() and "
            "screenshot() are for the program that it is called from");
    if (size.minCoeff() < 1) return false;
    updating_ = true;
    struct Done {
        bool& updating;
        ~Done() { updating = false; }
    } done{updating_};
    return update_now(events, size, scale, seconds);
}

app::LiveNeeds LiveView::needs() const {
    const PanelLayout& panels = state_.panels;
    app::LiveNeeds needs;
    needs.interrupt = input_waits_;
    needs.moving = gui_.is_active() || state_.manipulator.drag.axis >= 0;
    needs.pass_times = panels.shown && panels.open[size_t(Panel::statistics)];
    needs.surfaces =
        panels.shown && state_.path_panel.shows_path && !state_.live.path().editor.keys().empty();
    return needs;
}

bool LiveView::update_now(const std::vector<InputEvent>& events, Vec2i size, float scale, double seconds) {
    scale = std::clamp(scale * state_.screen.panel_scale, least_scale, most_scale);
    bool changed = state_.screen.size != size || state_.screen.scale != scale || !events.empty();
    state_.screen.size = size;
    state_.screen.scale = scale;
    live_.begin_frame(size, seconds);
    for (const InputEvent& event : events) handle(event);
    const gl::ContextScope scope(live_.session().context());
    follow_device();
    leave_menu_free();
    const bool drew = live_.draw(needs());
    const app::Notifications& messages = live_.notifications();
    changed |= std::exchange(told_, messages.revision()) != messages.revision();
    if (changed || drew) gui_frames_ = 3;
    // What a user's panel shows may change though nothing happens.
    const bool asks_panels =
        !live_.panels().empty() && state_.panels.shown && (since_panels_ += seconds) >= panels_seconds;
    bool draws = gui_frames_ > 0;
    if (draws || asks_panels) draws = draw_screen(seconds, draws);
    gui_frames_ = std::max(gui_frames_ - 1, int(gui_.has_keys()));
    const uint64_t told = messages.revision();
    live_.end_frame(needs(), {[this] { return finished_now(); }, [this] { return screen(); }});
    if (live_.recording().is_running()) gui_frames_ = std::max(gui_frames_, 1);
    if (messages.revision() != told) touch();
    return draws;
}

void LiveView::leave_menu_free() {
    const double part = gui_.menu_height(state_) / state_.screen.size.y();
    live_.session().set_insets({.top = std::min(part, 0.5)});
}

void LiveView::follow_device() {
    const uint64_t device = live_.session().device_number();
    if (std::exchange(device_, device) == device) return;
    gui_.forget_device();
    images_.forget_device();
    screen_ = gl::Texture();
    screen_framebuffer_ = gl::Framebuffer();
    touch();
}

void LiveView::handle(const InputEvent& event) {
    while (gui_.needs_frame_before(event)) {
        const gl::ContextScope scope(live_.session().context());
        follow_device();
        lay_out(0);
    }
    const bool own = event.kind != Kind::drop && gui_.take(event);
    if (own) return live_.leave(event);
    if (live_.offer(event) || shortcut(event)) return;
    if (!drag_handle(state_, event)) live_.handle(event);
}

bool LiveView::shortcut(const InputEvent& event) {
    if (event.repeat) return false;
    PanelLayout& panels = state_.panels;
    if (event.kind == Kind::text && event.code == '?') return panels.keys = !panels.keys, true;
    if (event.kind != Kind::key_down || event.control) return false;
    const int panel = event.key - app::key::f1;
    if (panel >= 0 && panel < panel_count) return panels.open[size_t(panel)] ^= true, true;
    switch (event.key) {
        case app::key::escape:
            return std::exchange(panels.keys, false) || cancel_drag(state_);
        case 'H':
            panels.shown = !panels.shown;
            return true;
        case 'T':
        case 'R':
        case 'Y':
            state_.manipulator.handle = event.key == 'T'   ? Handle::move
                                        : event.key == 'R' ? Handle::turn
                                                           : Handle::scale;
            return true;
        default:
            return false;
    }
}

bool LiveView::lay_out(double seconds) {
    return gui_.lay_out(state_, seconds, live_.picture().texture(), [&] {
        if (!state_.panels.shown) return;
        images_.draw(state_);
        user_panels_.draw(state_);
    });
}

bool LiveView::draw_screen(double seconds, bool always) {
    const Vec2i size = state_.screen.size;
    const bool is_new = !screen_ || screen_.width() != size.x() || screen_.height() != size.y();
    if (is_new) {
        screen_ = gl::Texture(gl::Format::rgba8, size.x(), size.y());
        screen_framebuffer_ = gl::Framebuffer({&screen_});
    }
    since_panels_ = 0;
    const bool changed = lay_out(seconds);
    if (!always && !changed && !is_new) return false;
    const float grey[4] = {0.25f, 0.25f, 0.25f, 1};
    screen_framebuffer_.clear_color(0, grey);
    gui_.paint(screen_framebuffer_);
    return true;
}

Image LiveView::screen() {
    if (!screen_) throw ArgumentError("nothing has been drawn yet");
    const gl::ContextScope scope(live_.session().context());
    if (device_ != live_.session().device_number())
        throw gl::ContextLost("the screen was lost with its context");
    Image image(screen_.width(), screen_.height(), 4, PixelType::u8);
    screen_framebuffer_.read(0, gl::Format::rgba8, 0, 0, image.width(), image.height(), image.bytes());
    gl::Context::check();
    return image;
}

Image LiveView::finished_now() {
    live_.draw_finished(needs());
    draw_screen(0, true);
    return screen();
}

Image LiveView::finished_screen(Vec2i size, float scale) {
    check_scale("screenshot: scale", scale);
    app::check_picture_size(size);
    touch();
    // Input is taken afterwards: a picture begun anew would never end.
    struct Restored {
        std::function<bool()>& function;
        std::function<bool()> kept = std::exchange(function, nullptr);
        ~Restored() { function = std::move(kept); }
    } const restored{input_waits_};
    const uint64_t begun = live_.picture().statistics().pictures;
    int idle = 0;
    do {
        check_interrupt();
        const InterruptScope whole({});  // Panels must be drawn whole.
        update({}, size, scale, 1.0 / 60);
        idle = live_.is_busy() ? 0 : idle + 1;
    } while (is_busy() && idle < most_gui_frames &&
             live_.picture().statistics().pictures < begun + most_changes);
    return screen();
}

}  // namespace easypbr::gui
