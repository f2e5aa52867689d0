// LiveView: a live drawing with panels over it. Input events go in, the screen comes out; with a window or
// without one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "easypbr/app/live_drawing.h"
#include "easypbr/gui/gui.h"
#include "easypbr/gui/image_panels.h"
#include "easypbr/gui/state.h"
#include "easypbr/gui/user_panel_windows.h"

namespace easypbr::gui {

/// Used by one thread at a time. While nothing changes nothing is drawn.
class LiveView {
  public:
    /// A view with a clock, a recorder and a player of its own.
    explicit LiveView(app::Session& session);
    /// With those of a program. All must outlive the view.
    LiveView(app::Session& session, app::Recorder& recorder, app::AnimationPlayer& player);
    LiveView(const LiveView&) = delete;
    LiveView& operator=(const LiveView&) = delete;

    /// Takes what has happened in `seconds` and draws what is to be drawn. Returns whether the screen
    /// changed. Errors in what is drawn become notifications. Throws ArgumentError when it is called from a
    /// panel or callback of its own.
    bool update(const std::vector<app::InputEvent>& events, Vec2i size, float scale, double seconds);

    /// There is more to draw, though nothing happens.
    bool is_busy() const { return live_.is_busy() || gui_frames_ > 0; }
    /// Escape was pressed, or close() was called.
    bool wants_to_close() { return live_.wishes().close; }
    void close(bool close = true) { live_.wishes().close = close; }

    /// Has frames that refine given up when it returns true, for input waits: called often while update()
    /// draws them. finished_screen() does not ask.
    void set_interrupt(std::function<bool()> input_waits) { input_waits_ = std::move(input_waits); }

    /// The screen, RGBA u8, row 0 on top: picture and GUI. Throws ArgumentError before the first update().
    Image screen();
    /// The screen when all is refined; draws until then. What panels and callbacks change in every frame is
    /// taken as it is after a few. Throws ArgumentError for a size that no picture has, and for a scale that
    /// is not from 0.5 to 4; Interrupted between two frames.
    Image finished_screen(Vec2i size, float scale = 1);

    /// What is looked at, without the panels.
    app::LiveDrawing& drawing() { return live_; }
    /// After a change to it, or to drawing(), call touch(), which has the GUI drawn again.
    GuiState& state() { return state_; }
    void touch() { gui_frames_ = 3; }
    /// Where the named items of the panels are, in the last frame.
    const ItemPlaces& places() const { return gui_.places(); }

    /// Panels of the user's own; their functions run within update(), while the panels are shown. May be
    /// called by such a function.
    void add_panel(const std::string& name, app::PanelFunction function);
    void remove_panel(const std::string& name);
    const app::UserPanels& panels() { return live_.panels(); }

    /// Shows an image in a window beside the scene; see ImagePanels.
    void show_image(const std::string& name, Image image, const ImageLook& look = {});
    void remove_image(const std::string& name);
    const ImagePanels& images() const { return images_; }

    /// The recorder's panel records; its frames are those of the clock.
    bool is_recording() const { return live_.recording().is_running(); }
    /// Ends what the recorder's panel began. Errors become notifications.
    void stop_recording();

    /// Calls `handler` for whatever happens but what the panels take for themselves, before the view acts on
    /// it; true keeps the view from that. What it throws becomes a notification. Returns a number for
    /// remove_event_handler().
    int on_event(app::EventHandler handler) { return live_.handlers().add(std::move(handler)); }
    void remove_event_handler(int number) { live_.handlers().remove(number); }

    /// A number that no other callback has.
    int next_callback_number() { return live_.handlers().next_number(); }
    /// Calls a user's function; see app::EventHandlers.
    bool guarded(const std::function<void()>& function) { return live_.handlers().guarded(function); }

    /// How large panels, text and handles are, 1 as the screen asks for; 8 times at most with the screen's
    /// own scale. Throws ArgumentError unless it is from 0.5 to 4.
    void set_panel_scale(float scale);

  private:
    void add_menu();
    bool update_now(const std::vector<app::InputEvent>& events, Vec2i size, float scale, double seconds);
    void handle(const app::InputEvent& event);
    bool shortcut(const app::InputEvent& event);
    app::LiveNeeds needs() const;
    bool lay_out(double seconds);
    bool draw_screen(double seconds, bool always);
    Image finished_now();
    /// An automatic camera shows the content below the menu bar.
    void leave_menu_free();
    /// What was made in a context that is no longer the session's is forgotten.
    void follow_device();

    app::LiveDrawing live_;
    GuiState state_{live_};
    Gui gui_;
    UserPanelWindows user_panels_;
    ImagePanels images_;

    std::function<bool()> input_waits_;
    uint64_t device_ = 0;  ///< that all here is of, see app::Session::device_number()
    gl::Texture screen_;
    gl::Framebuffer screen_framebuffer_;
    bool updating_ = false;
    int gui_frames_ = 3;       ///< that are still to be drawn, so that the GUI settles
    double since_panels_ = 0;  ///< seconds since the user's panels were called
    uint64_t told_ = 0;        ///< revision of the notifications on the screen
};

}  // namespace easypbr::gui
