#include "easypbr/viewer/viewer.h"

#include <chrono>

#include "easypbr/app/output.h"
#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/drawing/line_drawing.h"
#include "easypbr/gui/display.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/gui/window.h"
#include "easypbr/remote/orbit_page.h"
#include "easypbr/scene/settings.h"

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
        : live(session, recorder, player), seen(session.settings()) {}

    gui::LiveView live;
    std::unique_ptr<gui::Window> window;
    std::string title;
    bool closed = false, updating = false;
    std::optional<Clock::time_point> last;
    Settings seen;  ///< at the end of the last draw()
    Callbacks before, after;

    // A copy, as they may add and remove others.
    void call(Callbacks functions) {
        for (const auto& [number, function] : functions) live.guarded(function);
    }
    int keep(Callbacks& functions, std::function<void()> function) {
        if (!function) throw ArgumentError("a callback is no function");
        const int number = live.next_callback_number();
        functions[number] = std::move(function);
        return number;
    }

    void open(Vec2i size) {
        window = std::make_unique<gui::Window>(title, size);
        live.set_interrupt([this] { return window && window->has_input(); });
        // Fields of a screenshot use it too, when the window is closed.
        live.drawing().clipboard() = {[this] { return window ? window->clipboard() : std::string(); },
                                      [this](const std::string& text) {
                                          if (window) window->set_clipboard(text);
                                      }};
    }

    /// Draws by a function. How the settings were changed since the last time is the program's doing.
    template <class Draw>
    auto draw(Draw&& function) {
        app::LiveDrawing& drawing = live.drawing();
        drawing.edits().leave_to_program(seen);
        struct Seen {
            Settings& seen;
            const Settings& settings;
            ~Seen() { seen = settings; }
        } const at_end{seen, drawing.session().settings()};
        return function();
    }

    /// Seconds since the last call.
    double tick() {
        const Clock::time_point now = Clock::now();
        const double seconds = last ? std::chrono::duration<double>(now - *last).count() : 0;
        last = now;
        return seconds;
    }
};

struct Viewer::Parts {
    app::Session session;
    app::Clock clock;
    app::AnimationPlayer player{clock};

    explicit Parts(const Scene& scene) : session(scene) {
        clock.on_tick = [this] { player.update(); };
        clock.on_set = [this] { player.follow_set_clock(); };
        player.on_jump = [this](const MovedMeshes& moved) { session.replace_motion(moved); };
    }
};

Viewer::~Viewer() = default;

Viewer::Window& Viewer::window() {
    if (!window_) window_ = std::make_unique<Window>(parts_->session, recorder, parts_->player);
    return *window_;
}

gui::LiveView& Viewer::live() {
    return window().live;
}

template <class Front>
std::shared_ptr<Front> Viewer::with_panels(std::shared_ptr<Front> front) const {
    for (const auto& [name, function] : panels_) front->add_panel(name, function);
    return front;
}

template <class Work>
void Viewer::for_front_ends(Work&& work) {
    const auto each = [&](auto& all) {
        std::erase_if(all, [](const auto& one) { return one.expired(); });
        for (const auto& reference : all)
            if (const auto one = reference.lock()) work(*one);
    };
    each(servers_);
    each(channels_);
}

std::shared_ptr<remote::Server> Viewer::serve(const remote::ServeOptions& options) {
    const auto server = std::make_shared<remote::Server>(scene(), settings(), options);
    servers_.push_back(server);
    return with_panels(server);
}

std::shared_ptr<remote::Channel> Viewer::open_channel() {
    const auto channel = std::make_shared<remote::Channel>(scene(), settings());
    channels_.push_back(channel);
    return with_panels(channel);
}

void Viewer::tell_servers() {
    for_front_ends([&](auto& each) { each.take_settings(settings()); });
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
        parts_->clock.tick();
    w.call(w.before);
    const bool changed =
        w.draw([&] { return w.live.update(events, w.window->size(), w.window->scale(), seconds); });
    w.call(w.after);
    tell_servers();
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
    live().add_panel(name, function);
    for_front_ends([&](auto& each) { each.add_panel(name, function); });
    std::erase_if(panels_, [&](const auto& panel) { return panel.first == name; });
    panels_.emplace_back(name, std::move(function));
}

void Viewer::remove_panel(const std::string& name) {
    live().remove_panel(name);
    std::erase_if(panels_, [&](const auto& panel) { return panel.first == name; });
    for_front_ends([&](auto& each) { each.remove_panel(name); });
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
    Window& w = window();
    return w.draw([&] { return w.live.finished_screen(size.value_or(settings().image.size), scale); });
}

Scene& default_scene() {
    static Scene scene;
    return scene;
}

void show(const Mesh& mesh, const std::string& name) {
    default_scene().show(mesh, name);
}

void clear() {
    default_scene().clear();
}

Viewer::Viewer() : Viewer(default_scene()) {}

Viewer::Viewer(const Scene& scene)
    : parts_(std::make_unique<Parts>(scene)), recorder(parts_->session, parts_->clock) {}

Viewer::Viewer(const Scene& scene, DrawDevice device) : Viewer(scene) {
    parts_->session.use_device(device);
}

Viewer::Viewer(DrawDevice device) : Viewer(default_scene(), device) {}

DrawDevice Viewer::device() {
    return parts_->session.context_info().device;
}

Scene& Viewer::scene() {
    return parts_->session.scene();
}

Settings& Viewer::settings() {
    return parts_->session.settings();
}

app::Session& Viewer::session() {
    return parts_->session;
}

app::Clock& Viewer::clock() {
    return parts_->clock;
}

double Viewer::time() const {
    return parts_->clock.time();
}

double Viewer::delta_time() const {
    return parts_->clock.delta_time();
}

app::AnimationPlayer& Viewer::player() {
    return parts_->player;
}

void Viewer::pause() {
    parts_->player.pause();
}

Image Viewer::render(const app::PictureOptions& options) {
    // Without a window and a recording, which have frames of their own, each image is a frame.
    if (is_open() || recorder.is_recording()) return parts_->session.render(options);
    parts_->clock.tick();
    try {
        return parts_->session.render(options);
    } catch (...) {
        parts_->clock.take_back();
        throw;
    }
}

std::map<std::string, Image> Viewer::render_layers(const std::vector<std::string>& names,
                                                   std::optional<Vec2i> size) {
    return parts_->session.render_layers(names, size);
}

app::Moment Viewer::moment(std::optional<Vec2i> size) {
    return parts_->session.moment(size);
}

Camera Viewer::camera() {
    return parts_->session.camera();
}

void Viewer::set_camera(const Camera& camera) {
    parts_->session.set_camera(camera);
}

void Viewer::forget_motion() {
    parts_->session.forget_motion();
}

double Viewer::focus_at(int x, int y, std::optional<Vec2i> size) {
    return parts_->session.focus_at(x, y, size);
}

void Viewer::refit() {
    parts_->session.refit();
}

std::filesystem::path Viewer::save_html(const std::filesystem::path& path,
                                        const app::OrbitPageOptions& options) {
    return remote::save_orbit_page(parts_->session, path, options);
}

std::filesystem::path Viewer::save_svg(const std::filesystem::path& path,
                                       const app::LineDrawingOptions& options) {
    return drawing::save_line_drawing(parts_->session, path, options);
}

void Viewer::save_settings(const std::filesystem::path& path,
                           const std::vector<std::filesystem::path>& files) {
    app::save_settings(parts_->session, files, path);
}

void Viewer::load_settings(const std::filesystem::path& path) {
    app::load_settings(parts_->session, path);
}

void Viewer::apply_preset(const std::string& name_or_path) {
    app::apply_preset(parts_->session, name_or_path);
}

std::optional<app::Pick> Viewer::pick(Vec2d pixel, std::optional<Vec2i> size) {
    return parts_->session.pick(pixel, size);
}

void Viewer::add_pass(const std::string& name, app::Stage stage, std::shared_ptr<app::Pass> pass) {
    parts_->session.add_pass(name, stage, std::move(pass));
}

void Viewer::remove_pass(const std::string& name) {
    parts_->session.remove_pass(name);
}

void Viewer::add_light(const std::string& name, const Light& light) {
    scene().set_light(name, light);
}

void Viewer::remove_light(const std::string& name) {
    scene().remove_light(name);
}

void Viewer::play(const Animations& animations, const std::string& animation, double speed, bool loop) {
    animations.find(animation);  // Throws before anything is changed.
    parts_->player.set_speed(speed);
    parts_->player.set_loop(loop);
    parts_->player.add("", animations, scene());
    parts_->player.play("", animation);
}

void Viewer::show_image(const std::string& name, Image image, const app::ImageLook& look) {
    live().show_image(name, std::move(image), look);
}

void Viewer::remove_image(const std::string& name) {
    live().remove_image(name);
}

Viewer::Viewer(Vec2i size, const std::filesystem::path& settings) : Viewer(default_scene()) {
    if (!settings.empty()) app::load_settings(parts_->session, settings);
    parts_->session.settings().image.size = size;
}

void Viewer::load_environment_map(const std::filesystem::path& path) {
    parts_->session.load_environment(path);
}

void Viewer::load_background_image(const std::filesystem::path& path) {
    parts_->session.load_background(path);
}

void Viewer::set_background_image(Image image) {
    parts_->session.set_background(std::move(image));
}

}  // namespace easypbr
