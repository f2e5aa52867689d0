#include "easypbr/viewer/viewer.h"

#include <chrono>

#include "easypbr/gui/live_view.h"
#include "easypbr/gui/window.h"

namespace easypbr {
namespace {

using Clock = std::chrono::steady_clock;

/// How long update() waits for something to happen.
constexpr double wait_seconds = 0.016;
/// A pause of the program is no reason to fly far.
constexpr double longest_step = 0.1;

std::string title_of(const Scene& scene) {
    std::string title;
    for (const std::string& name : scene.names()) title += (title.empty() ? "" : ", ") + name;
    return title.empty() ? "EasyPBR" : title + " - EasyPBR";
}

}  // namespace

struct Viewer::Window {
    explicit Window(app::Session& session) : live(session) {}

    gui::LiveView live;
    std::unique_ptr<gui::Window> window;
    std::string title;
    bool closed = false;
    std::optional<Clock::time_point> last;

    void open(Vec2i size) {
        window = std::make_unique<gui::Window>(title, size);
        live.state().read_clipboard = [this] { return window->clipboard(); };
        live.state().write_clipboard = [this](const std::string& text) { window->set_clipboard(text); };
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

gui::LiveView& Viewer::live() {
    if (!window_) window_ = std::make_unique<Window>(*session_);
    return window_->live;
}

bool Viewer::update() {
    live();
    Window& w = *window_;
    if (w.closed) return false;
    const std::string title = title_of(scene());
    if (!w.window) {
        w.title = title;
        w.open(settings().image.size);
    }
    if (w.title != title) w.window->set_title(w.title = title);
    const auto events = w.window->events(w.live.is_busy() ? 0 : wait_seconds);
    const double seconds = std::min(w.tick(), longest_step);
    if (recorder.is_recording())
        recorder.add_frame();
    else
        clock_->tick();
    const bool changed = w.live.update(events, w.window->size(), w.window->scale(), seconds);
    if (w.window->should_close() || w.live.wants_to_close()) {
        close();
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

void Viewer::close() {
    if (!window_) return;
    window_->closed = true;
    window_->live.state().close = false;
    window_->window.reset();
}

bool Viewer::is_open() const {
    return window_ && window_->window;
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
      recorder(*session_, *clock_) {}

Viewer::Viewer(Vec2i size, const std::filesystem::path& settings) : Viewer(default_scene()) {
    if (!settings.empty()) app::load_settings(*session_, settings);
    session_->settings().image.size = size;
}

void Viewer::load_environment_map(const std::filesystem::path& path) {
    session_->load_environment(path);
}

}  // namespace easypbr
