// Gui: a Dear ImGui context with its renderer; lays the panels out and draws them over a picture.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "easypbr/app/input.h"
#include "easypbr/gui/imgui_renderer.h"
#include "easypbr/gui/item_places.h"
#include "easypbr/gui/state.h"

struct ImGuiContext;

namespace easypbr::gui {

/// What the fields of a GUI copy to and paste from, in a frame.
struct FieldClipboard {
    app::Clipboard* clipboard = nullptr;
    std::string text;     ///< read last
    std::string failure;  ///< why it could not be read or written
};

/// Dear ImGui serves one thread at a time: viewers on several threads take turns here.
class Gui {
  public:
    Gui();
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// Whether the next lay_out() could not tell this event from what has happened since the last one: a
    /// button or the wheel counts where the pointer was, and decides to whom the keys after it belong.
    bool needs_frame_before(const app::InputEvent& event) const;
    /// Tells the GUI what happened. Returns whether the event is its own: over a panel, or typed into a
    /// field. Escape is its own while a menu or list is open, which it closes, and while is_active(). A
    /// button or key is its own until it comes up when it was as it went down.
    bool take(const app::InputEvent& event);
    /// The pointer drags a slider or the like, or a field is typed into.
    bool is_active() const { return active_; }
    /// Keys wait for the next frame: one frame tells neither their order nor a key that goes down twice.
    bool has_keys() const { return !keys_.empty(); }

    /// What was uploaded is gone with its context, and is uploaded again.
    void forget_device();

    /// Lays out everything over the picture (stretched over all of the window; may be empty); `more` adds
    /// windows of its own. Returns whether it looks unlike the last time, but for what is in pictures. The
    /// session's context must be current.
    bool lay_out(GuiState& state, double seconds, const gl::Texture& picture,
                 const std::function<void()>& more = {});
    /// Height of the menu bar in pixels; 0 while the panels are hidden. The session's context must be
    /// current.
    float menu_height(const GuiState& state);
    /// Draws what was laid out last. The session's context must be current.
    void paint(const gl::Framebuffer& target);
    /// Where the named items of the last lay_out() are.
    const ItemPlaces& places() const { return places_; }

  private:
    /// Font, theme, size and time of a frame.
    void prepare(const GuiState& state, double seconds);
    /// The buttons that are down, and those that were for a moment since the last frame.
    void hand_over_input();
    /// Keys and letters up to the first key that changes a text.
    void hand_over_keys();
    /// Makes a notification of what failed in a frame; empty: nothing did.
    void tell(GuiState& state, const std::string& failure);
    void draw_panels(GuiState& state, const std::function<void()>& more);

    ImGuiContext* context_ = nullptr;
    ImGuiRenderer renderer_;
    ItemPlaces places_;     ///< ImGui's UserData, see note_place()
    std::string laid_out_;  ///< hash of what was laid out last
    float font_scale_ = 0, theme_scale_ = 0;
    Theme theme_ = Theme::dark;
    bool over_panel(Vec2d position) const;
    void take_button(const app::InputEvent& event);
    bool take_key(const app::InputEvent& event);

    bool wants_keys_ = false, active_ = false, popup_ = false;
    bool closes_popups_ = false;               ///< in the next frame
    std::string failure_;                      ///< of the last frame, told
    std::vector<Eigen::AlignedBox2d> panels_;  ///< where windows of the last frame take the mouse
    /// A click within one frame is held down for all of it, or the GUI would not see it.
    std::array<bool, 3> down_{}, pressed_{};
    std::vector<app::MouseButton> owned_;  ///< buttons that went down over a panel
    std::set<int> owned_keys_;             ///< keys that went down for the GUI
    std::deque<app::InputEvent> keys_;     ///< keys and letters that no frame has had yet
    FieldClipboard field_clipboard_;
};

}  // namespace easypbr::gui
