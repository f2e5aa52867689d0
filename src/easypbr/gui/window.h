// Window: shows pictures and collects what a person does. It has a small OpenGL context of its own, used for
// nothing but showing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easypbr/app/input.h"
#include "easypbr/core/image.h"
#include "easypbr/gui/key_codes.h"

struct GLFWwindow;

namespace easypbr::gui {

/// Any number of windows, on any threads: each call waits for others. A window may be destroyed on any
/// thread.
class Window {
  public:
    /// The size is in plain pixels: on a HiDPI screen it is multiplied by the screen's scale. Throws
    /// ContextError when there is no GLFW or no display.
    Window(const std::string& title, Vec2i size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What has happened since the last call; waits up to `seconds` for something. Throws ContextError when
    /// the display has gone away.
    std::vector<app::InputEvent> events(double seconds);
    /// Whether the next events() hold a button, the wheel or a key. Looks at most every few milliseconds, so
    /// that it can be asked often. Never throws.
    bool has_input() noexcept;

    /// Size in pixels; 0 while it is minimised.
    Vec2i size() const;
    /// Pixels of the screen for each of a plain one (HiDPI).
    float scale() const;
    bool should_close() const;

    /// Shows an RGBA u8 picture, row 0 on top, stretched over the window.
    void present(const Image& picture);
    /// The window system lost what was shown.
    bool needs_present() const { return needs_present_; }

    /// Throws ContextError when the program that holds the clipboard does not answer within a second.
    std::string clipboard() const;
    void set_clipboard(const std::string& text);
    void set_title(const std::string& title);

  private:
    friend struct WindowCallbacks;
    void make_target(Vec2i size);
    void show();
    /// Whether something has happened.
    bool poll_events();

    GLFWwindow* window_ = nullptr;
    std::vector<app::InputEvent> events_;
    KeyCodes key_codes_;
    int modifiers_ = 0;             ///< GLFW's bits, after the last event
    bool repeats_ = false;          ///< the last key's event was a repetition
    bool outside_ = false;          ///< the pointer has left, though a drag may go on
    int buttons_ = 0;               ///< bits of those that are down
    std::optional<Vec2d> pointer_;  ///< at the last event, in screen coordinates
    bool needs_present_ = true;
    bool is_shown_ = false;
    bool input_waits_ = false;
    double looked_ = 0;  ///< when has_input() last did
    double asked_to_show_ = 0;
    unsigned texture_ = 0, framebuffer_ = 0;
    Vec2i target_size_{0, 0};
};

}  // namespace easypbr::gui
