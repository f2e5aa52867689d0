#include "easypbr/viewer/viewer.h"

#include <chrono>

#include "easypbr/core/error.h"
#include "easypbr/gui/display.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/gui/window.h"

namespace easypbr {
namespace {

using Clock = std::chrono::steady_clock;

/// How long update() waits for something to happen.
constexpr double wait_seconds = 0.016;
/// A pause of the program is no reason to fly far.
constexpr double longest_step = 0.1;

using Callbacks = std::map<int, std::function<void()>>;

/// A flag that is true for a scope.
class KeptTrue {
  public:
    explicit KeptTrue(bool& flag) : flag_(flag) { flag_ = true; }
    ~KeptTrue() { flag_ = false; }
    KeptTrue(const KeptTrue&) = delete;
    KeptTrue& operator=(const KeptTrue&) = delete;

  private:
    bool& flag_;
};

std::string title_of(const Scene& scene) {
    std::string title;
    for (const std::string& name : scene.names()) title += (title.empty() ? "" : ", ") + name;
    return title.empty() ? "EasyPBR" : title + " - EasyPBR";
}

}  // namespace

struct Viewer::Window {
    explicit Window(app::Session& session, app::Recorder& recorder, app::AnimationPlayer& player)
        : live(session, recorder, player) {}

    gui::LiveView live;
    std::unique_ptr<gui::Window> window;
    std::string title;
    bool closed = false, updating = false;
    std::optional<Clock::time_point> last;
    Callbacks before, after;

    void call(const Callbacks& functions) {
        const Callbacks present = functions;  // They may add and remove others.
        for (const auto& [number, function] : present) live.guarded(function);
    }
    int keep(Callbacks& functions, std::function<void()> function) {
        if (!function) throw ArgumentError("a callback is no function");
        const int number = live.next_callback_number();
        functions[number] = std::move(function);
        return number;
    }

    void open(Vec2i size) {
        window = std::make_unique<gui::Window>(title, size);
        live.drawing().clipboard() = {[this] { return window->clipboard(); },
                                      [this](const std::string& text) { window->set_clipboard(text); }};
    }

    /// Seconds since the last call.
    double tick() {
        const Clock::time_point now = Clock::now();
        const double seconds = last ? std::chrono::duration<double>(now - *last).count() : 0;
        last = now;
        return seconds;
    }
};

Viewer::~Viewer() = default;

Viewer::Window& Viewer::window() {
    if (!window_) window_ = std::make_unique<Window>(*session_, recorder, *player_);
    return *window_;
}

gui::LiveView& Viewer::live() {
    return window().live;
}

bool Viewer::update() try { return update_window(); } catch (const Error&) {
    if (!gui::display_is_lost()) throw;
    close();
    recorder.stop();
    throw;
}

bool Viewer::update_window() {
    Window& w = window();
    if (w.closed) return false;
    if (w.updating) throw ArgumentError("update() is called from a callback of its own");
    const KeptTrue updating(w.updating);
    const std::string title = title_of(scene());
    if (!w.window) {
        w.title = title;
        w.open(settings().image.size);
    }
    if (w.title != title) w.window->set_title(w.title = title);
    const auto events = w.window->events(w.live.is_busy() ? 0 : wait_seconds);
    const double seconds = std::min(w.tick(), longest_step);
    // Frames that the window's panel records let the clock tick themselves.
    if (recorder.is_recording() && !w.live.is_recording())
        recorder.add_frame();
    else if (!w.live.is_recording())
        clock_->tick();
    w.call(w.before);
    const bool changed = w.live.update(events, w.window->size(), w.window->scale(), seconds);
    w.call(w.after);
    if (w.window->should_close() || w.live.wants_to_close()) {
        shut(w);
        return false;
    }
    if ((changed || w.window->needs_present()) && w.window->size().minCoeff() > 0)
        w.window->present(w.live.screen());
    return true;
}

void Viewer::reopen() {
    if (window_) window_->closed = false;
}

void Viewer::show() {
    reopen();
    while (update()) continue;
}

void Viewer::shut(Window& window) {
    window.live.stop_recording();
    window.closed = true;
    window.live.close(false);
    window.window.reset();
}

void Viewer::close() {
    if (!window_) return;
    // In a callback it is update() that closes, for it still needs the window.
    if (window_->updating)
        window_->live.close();
    else
        shut(*window_);
}

bool Viewer::is_open() const {
    return window_ && window_->window;
}

void Viewer::add_panel(const std::string& name, std::function<void(app::Widgets&)> function) {
    live().add_panel(name, std::move(function));
}

void Viewer::remove_panel(const std::string& name) {
    live().remove_panel(name);
}

int Viewer::before_draw(std::function<void()> function) {
    return window().keep(window().before, std::move(function));
}

int Viewer::after_draw(std::function<void()> function) {
    return window().keep(window().after, std::move(function));
}

int Viewer::on_event(std::function<bool(const app::InputEvent&)> handler) {
    return live().on_event(std::move(handler));
}

void Viewer::remove_callback(int number) {
    window().before.erase(number);
    window().after.erase(number);
    live().remove_event_handler(number);
}

Image Viewer::screenshot(std::optional<Vec2i> size, float scale) {
    return live().finished_screen(size.value_or(settings().image.size), scale);
}

Scene& default_scene() {
    static Scene scene;
    return scene;
}

Viewer::Viewer(const Scene& scene)
    : session_(std::make_unique<app::Session>(scene)),
      clock_(std::make_unique<app::Clock>()),
      player_(std::make_unique<app::AnimationPlayer>(*clock_)),
      recorder(*session_, *clock_) {
    clock_->on_tick = [player = player_.get()] { player->update(); };
}

void Viewer::play(const Animations& animations, const std::string& animation, double speed, bool loop) {
    player_->set_speed(speed);
    player_->set_loop(loop);
    player_->add("", animations);
    player_->play("", animation);
}

void Viewer::show_image(const std::string& name, Image image, const gui::ImageLook& look) {
    live().show_image(name, std::move(image), look);
}

void Viewer::remove_image(const std::string& name) {
    live().remove_image(name);
}

Viewer::Viewer(Vec2i size, const std::filesystem::path& settings) : Viewer(default_scene()) {
    if (!settings.empty()) app::load_settings(*session_, settings);
    session_->settings().image.size = size;
}

void Viewer::load_environment_map(const std::filesystem::path& path) {
    session_->load_environment(path);
}

}  // namespace easypbr
