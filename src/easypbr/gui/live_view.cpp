#include "easypbr/gui/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "easypbr/app/camera_text.h"
#include "easypbr/app/output.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/gui/panels.h"
#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::gui {
namespace {

namespace fs = std::filesystem;
using app::InputEvent;
using Kind = InputEvent::Kind;

constexpr double watch_seconds = 0.5;
/// How often the panels of users are called while nothing happens.
constexpr double panels_seconds = 0.05;

bool is_environment_file(const fs::path& path) {
    const std::string extension = extension_of(path);
    return extension == "hdr" || extension == "exr";
}

std::string unique_name(const Scene& scene, const std::string& stem) {
    std::string name = stem;
    for (int number = 2; scene.contains(name); ++number) name = fmt::format("{}-{}", stem, number);
    return name;
}

void show_loaded(Scene& scene, app::AnimationPlayer& player, const io::LoadedScene& loaded,
                 const std::string& name) {
    scene.show(loaded.mesh, name);
    if (!loaded.animations.empty()) player.add(name, loaded.animations);
    for (const auto& [light, value] : loaded.lights) scene.set_light(name + "/" + light, value);
}

}  // namespace

struct LiveView::Own {
    explicit Own(app::Session& session) : recorder(session, clock), player(clock) {}
    app::Clock clock;
    app::Recorder recorder;
    app::AnimationPlayer player;
};

LiveView::LiveView(app::Session& session) : LiveView(session, std::make_unique<Own>(session)) {}

LiveView::LiveView(app::Session& session, std::unique_ptr<Own> own)
    : LiveView(session, own->recorder, own->player) {
    own_ = std::move(own);
}

LiveView::~LiveView() = default;

LiveView::LiveView(app::Session& session, app::Recorder& recorder, app::AnimationPlayer& player)
    : session_(session), recorder_(recorder), recording_(session, recorder), state_(session) {
    state_.player = &player;
    state_.recording = &recording_;
    auto clipboard = std::make_shared<std::string>();
    state_.read_clipboard = [clipboard] { return *clipboard; };
    state_.write_clipboard = [clipboard](const std::string& text) { *clipboard = text; };
    state_.own_menu = [this] {
        panels_.menu();
        images_.menu();
    };
}

void LiveView::add_panel(const std::string& name, PanelFunction function) {
    panels_.add(name, std::move(function));
    touch();
}

void LiveView::remove_panel(const std::string& name) {
    panels_.remove(name);
    touch();
}

int LiveView::on_event(EventHandler handler) {
    if (!handler) throw ArgumentError("on_event: expected a function");
    const int number = next_callback_number();
    handlers_[number] = std::move(handler);
    return number;
}

bool LiveView::guarded(const std::function<void()>& function) {
    std::string text;
    try {
        function();
        return true;
    } catch (const std::exception& error) {
        text = error.what();
    } catch (...) {
        text = "an exception that is no std::exception";
    }
    // The same in every frame would hide the picture.
    if (std::exchange(last_failure_, text) != text) state_.notify(text, true);
    return false;
}

bool LiveView::handled_by_user(const InputEvent& event) {
    bool handled = false;
    const auto handlers = handlers_;  // They may add and remove others.
    for (const auto& [number, handler] : handlers) guarded([&] { handled |= handler(event); });
    return handled;
}

bool LiveView::is_moving() const {
    return (control_.is_moving() && control_.has_dragged()) || gui_.is_active() || state_.drag.axis >= 0 ||
           state_.path.is_playing();
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

void LiveView::set_panel_scale(float scale) {
    if (!(scale >= least_panel_scale && scale <= most_panel_scale))
        throw ArgumentError(fmt::format("panel scale: expected {} to {}, got {}", least_panel_scale,
                                        most_panel_scale, scale));
    state_.panel_scale = scale;
    touch();
}

bool LiveView::update_now(const std::vector<InputEvent>& events, Vec2i size, float scale, double seconds) {
    scale *= state_.panel_scale;
    bool changed = state_.size != size || state_.scale != scale || !events.empty();
    const bool resized = std::exchange(state_.size, size) != size;
    state_.scale = scale;
    if (resized) {
        InputEvent event;
        event.kind = Kind::resize;
        event.size = size;
        handled_by_user(event);
    }
    keep_looks();
    reload_changed(seconds);
    for (const InputEvent& event : events) handle(event);
    try {
        if (app::ViewPoint view;
            control_.is_moving() && (view = session_.view_point(size), control_.advance(seconds, view)))
            session_.set_view_point(view);
        if (std::exchange(state_.fit, false)) fit();
        if (std::exchange(state_.save, false)) save_settings(settings_file);
    } catch (const Error& error) {
        state_.notify(error.what(), true);
    }
    move_along_path(seconds);
    std::erase_if(state_.notifications, [&](Notification& n) { return (n.seconds_left -= seconds) <= 0; });
    const gl::ContextScope scope(session_.context());
    // While a path is recorded its frames are shown.
    const bool drew = !recording_.is_path() && draw_picture();
    changed |= std::exchange(told_, state_.notifications.size()) != state_.notifications.size();
    if (changed || drew) gui_frames_ = 3;
    // What a user's panel shows may change though nothing happens.
    const bool asks_panels =
        !panels_.empty() && state_.show_panels && (since_panels_ += seconds) >= panels_seconds;
    bool draws = gui_frames_ > 0;
    if (draws || asks_panels) draws = draw_screen(seconds, draws);
    gui_frames_ = std::max(gui_frames_ - 1, 0);
    record();
    if (!is_moving() && !failed_ && !recording_.is_path()) note_history(state_);
    const bool refines = !failed_ && frames_ < state_.statistics.total;
    busy_ = refines || gui_frames_ > 0 || control_.is_moving() || state_.path.is_playing() ||
            recording_.is_path();
    return draws;
}

void LiveView::handle(const InputEvent& event) {
    if (event.kind == Kind::drop) {
        if (handled_by_user(event)) return;
        for (const std::string& path : event.paths) try {
                open(path);
            } catch (const Error& error) {
                state_.notify(error.what(), true);
            }
        return;
    }
    const bool own = gui_.take(event);
    if (event.kind == Kind::move) {
        if (event.position != pointer_) zoom_about_.reset();
        pointer_ = event.position;
        wants_hover_ = !own;
        if (own) state_.hovered.reset();
    }
    if (own || handled_by_user(event) || shortcut(event)) return;
    // The release of a button that the manipulator holds is the camera's as well: it forgets nothing by it.
    const bool on_handle =
        state_.handles_pointer && event.kind == Kind::press && event.button == app::MouseButton::left;
    if (!on_handle) move_camera(event);
}

bool LiveView::shortcut(const InputEvent& event) {
    if (event.kind == Kind::text && event.code == '?') return state_.show_keys = !state_.show_keys, true;
    if (event.kind != Kind::key_down) return false;
    if (event.control) return control_shortcut(event.key);
    const int panel = event.key - app::key::f1;
    if (panel >= 0 && panel < panel_count) return state_.open[size_t(panel)] ^= true, true;
    switch (event.key) {
        case app::key::escape:
            if (state_.show_keys)
                state_.show_keys = false;
            else
                state_.close = true;
            return true;
        case 'K':
            if (!guarded([&] { add_path_key(state_); })) last_failure_.clear();
            return true;
        case 'H':
            state_.show_panels = !state_.show_panels;
            return true;
        case 'T':
        case 'R':
        case 'Y':
            state_.handle = event.key == 'T' ? Handle::move : event.key == 'R' ? Handle::turn : Handle::scale;
            return true;
        default:
            return false;
    }
}

bool LiveView::control_shortcut(int key) {
    try {
        if (key == 'Z') undo(state_);
        if (key == 'Y') redo(state_);
        if (key == 'S') state_.save = true;
        if (key == 'C') {
            state_.write_clipboard(app::camera_text(session_, state_.size));
            state_.notify("The camera is on the clipboard");
        }
        if (key == 'V') app::apply_camera_text(state_.read_clipboard(), session_.settings());
    } catch (const Error& error) {
        state_.notify(error.what(), true);
    }
    return true;
}

void LiveView::move_camera(const InputEvent& event) {
    const bool can_move = !session_.scene().names().empty() || !session_.settings().camera.pose.empty();
    if (!can_move) return;
    try {
        const app::ViewPoint before = session_.view_point(state_.size);
        app::ViewPoint view = before;
        const app::CameraControl::Wish wish =
            control_.handle(event, view, state_.size, parse_up(session_.settings().camera.up));
        if (view.camera.T_world_cam.matrix() != before.camera.T_world_cam.matrix())
            session_.set_view_point(view);
        state_.fit |= wish.fit;
        if (wish.zoom) zoom(*wish.zoom, wish.zoom_factor);
        if (wish.focus)
            if (const auto pick = surfaces().at(*wish.focus))
                session_.set_view_point(focused(session_.view_point(state_.size), pick->position));
        if (event.kind == Kind::press) pressed_ = event.position;
        const bool clicked = event.kind == Kind::release && event.button == app::MouseButton::left &&
                             !control_.has_dragged() && (event.position - pressed_).norm() < 3;
        if (clicked) click(event.position);
    } catch (const Error& error) {
        state_.notify(error.what(), true);
    }
}

const app::PickBuffer& LiveView::surfaces() {
    const uint64_t version = session_.picture_version(state_.size);
    if (!surfaces_ || surfaces_version_ != version || surfaces_->size() != state_.size) {
        const bool complete = frames_ >= state_.statistics.total;
        surfaces_.emplace(session_.pick_buffer(state_.size));
        surfaces_version_ = version;
        if (!complete) frames_ = 0;
    }
    return *surfaces_;
}

void LiveView::zoom(Vec2d pixel, double factor) {
    const app::ViewPoint view = session_.view_point(state_.size);
    if (!zoom_about_) {
        const auto pick = surfaces().at(pixel);
        zoom_about_ = pick ? pick->position : app::point_at(view.camera, pixel, state_.size, view.distance());
    }
    session_.set_view_point(zoomed(view, factor, *zoom_about_));
}

void LiveView::click(Vec2d pixel) {
    state_.picked = surfaces().at(pixel);
    state_.object = state_.picked ? state_.picked->object : "";
    state_.light.clear();
}

void LiveView::fit() {
    const SceneSnapshot scene = session_.scene().snapshot();
    if (scene.objects.empty()) return;
    CameraSettings lens = session_.settings().camera;
    const app::ViewPoint view = session_.view_point(state_.size);
    Camera camera =
        fit_camera(scene, view.camera.T_world_cam.linear(), lens, double(state_.size.x()) / state_.size.y());
    const Vec3d forward = -camera.T_world_cam.linear().col(2);
    const double depth = (scene.bounds().center() - camera.position()).dot(forward);
    session_.set_view_point({camera, camera.position() + forward * depth});
    if (camera.projection == Projection::orthographic) session_.settings().camera.ortho_height = automatic;
}

void LiveView::keep_looks() {
    std::map<std::string, Mesh> present;
    for (const auto& [object, changes] : state_.looks) {
        const std::optional<Mesh> node = node_named(session_.scene(), object);
        if (!node) continue;
        present.insert_or_assign(object, *node);
        const auto known = known_.find(object);
        if (known == known_.end() || known->second == *node) continue;
        Mesh shown = *node;
        for (const auto& [property, change] : changes) shown.edit(change);
    }
    known_ = std::move(present);
}

void LiveView::open(const fs::path& path) {
    if (is_environment_file(path)) {
        session_.load_environment(path);
        state_.notify("Environment: " + path.filename().string());
        return;
    }
    const io::LoadedScene loaded =
        io::load_scene(path, {.crease_angle_deg = session_.settings().load.crease_deg});
    const std::string name = unique_name(session_.scene(), path.stem().string());
    show_loaded(session_.scene(), *state_.player, loaded, name);
    state_.notify("Added " + name);
}

void LiveView::watch(const fs::path& path, const std::string& name) {
    watched_.push_back({path, name, fs::last_write_time(path)});
}

void LiveView::reload_changed(double seconds) {
    if (watched_.empty() || (since_watch_ += seconds) < watch_seconds) return;
    since_watch_ = 0;
    for (Watched& file : watched_) try {
            std::error_code gone;  // A file that is being replaced may be missing for a moment.
            const auto time = fs::last_write_time(file.path, gone);
            if (gone || time == file.time) continue;
            file.time = time;
            show_loaded(session_.scene(), *state_.player,
                        io::load_scene(file.path, {.crease_angle_deg = session_.settings().load.crease_deg}),
                        file.name);
            state_.notify("Reloaded " + file.name);
        } catch (const Error& error) {
            state_.notify(error.what(), true);
        }
}

void LiveView::save_settings(const fs::path& path) {
    std::set<fs::path> files;
    for (const std::string& name : session_.scene().names())
        if (const fs::path source = session_.scene().get(name).snapshot()->source; !source.empty())
            files.insert(source);
    app::save_settings(session_, {files.begin(), files.end()}, path);
    state_.notify(fmt::format("Saved {}: easypbr render --settings {} makes this picture", path.string(),
                              path.filename().string()));
}

}  // namespace easypbr::gui
