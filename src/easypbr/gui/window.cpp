#include "easypbr/gui/window.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/gui/clipboard.h"
#include "easypbr/gui/display.h"
#include "easypbr/gui/glfw.h"

namespace easypbr::gui {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;

static_assert(app::key::escape == GLFW_KEY_ESCAPE && app::key::del == GLFW_KEY_DELETE &&
              app::key::right == GLFW_KEY_RIGHT && app::key::end == GLFW_KEY_END &&
              app::key::f1 == GLFW_KEY_F1 && app::key::f12 == GLFW_KEY_F12);
static_assert(GLFW_KEY_KP_0 == 320 && GLFW_KEY_KP_5 == 325 && GLFW_KEY_KP_DECIMAL == 330 &&
              GLFW_KEY_KP_ENTER == 335 && GLFW_MOD_NUM_LOCK == 0x20);
static_assert(app::key::left_shift == GLFW_KEY_LEFT_SHIFT && app::key::right_alt == GLFW_KEY_RIGHT_ALT &&
              GLFW_MOD_SHIFT == 1 && GLFW_MOD_CONTROL == 2 && GLFW_MOD_ALT == 4);

constexpr double ask_again_seconds = 0.5;
/// How long the owner of the clipboard has to answer.
constexpr double clipboard_seconds = 1;

/// Threads that wait for the one that waits for events.
std::atomic<int> waiting_threads = 0;

/// Takes the mutex soon, also while another thread waits for events under it.
class GlfwLock {
  public:
    GlfwLock() : lock_(glfw_mutex(), std::defer_lock) {
        if (lock_.try_lock()) return;
        ++waiting_threads;
        if (started_) glfw_->glfwPostEmptyEvent();
        lock_.lock();
        --waiting_threads;
    }

    static const Glfw& functions() {
        glfw_ = &glfw();
        started_ = true;
        return *glfw_;
    }

  private:
    std::unique_lock<std::recursive_mutex> lock_;
    static inline const Glfw* glfw_ = nullptr;
    static inline std::atomic<bool> started_ = false;
};

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

/// GLFW's callbacks; they run within Window::events().
struct WindowCallbacks {
    static Window& of(GLFWwindow* window) {
        return *static_cast<Window*>(glfw().glfwGetWindowUserPointer(window));
    }
    static InputEvent& add(GLFWwindow* window, Kind kind) {
        Window& self = of(window);
        InputEvent event;
        event.kind = kind;
        event.time = now();
        event.position = in_pixels(window, pointer(window));
        event.shift = self.modifiers_ & GLFW_MOD_SHIFT;
        event.control = self.modifiers_ & GLFW_MOD_CONTROL;
        event.alt = self.modifiers_ & GLFW_MOD_ALT;
        self.events_.push_back(event);
        return self.events_.back();
    }
    /// Where the pointer was at this event. glfwGetCursorPos() asks X11 where it is now: at the end of a drag
    /// whose events are taken after a slow frame.
    static Vec2d pointer(GLFWwindow* window) {
        std::optional<Vec2d>& known = of(window).pointer_;
        if (!known) {
            known = Vec2d(0, 0);
            glfw().glfwGetCursorPos(window, &known->x(), &known->y());
        }
        return *known;
    }
    static Vec2d in_pixels(GLFWwindow* window, Vec2d position) {
        int width = 0, height = 0, pixels_x = 0, pixels_y = 0;
        glfw().glfwGetWindowSize(window, &width, &height);
        glfw().glfwGetFramebufferSize(window, &pixels_x, &pixels_y);
        if (width > 0 && height > 0)
            position = Vec2d(position.x() * pixels_x / width, position.y() * pixels_y / height);
        return position;
    }
    static void move(GLFWwindow* window, double x, double y) {
        of(window).pointer_ = Vec2d(x, y);
        add(window, Kind::move);
    }
    static void button(GLFWwindow* window, int button, int action, int mods) {
        if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
        of(window).modifiers_ = mods;
        InputEvent& event = add(window, action == GLFW_RELEASE ? Kind::release : Kind::press);
        event.button = app::MouseButton(button);
        int& buttons = of(window).buttons_;
        buttons = action == GLFW_RELEASE ? buttons & ~(1 << button) : buttons | 1 << button;
        leave(window);
    }
    static void enter(GLFWwindow* window, int entered) {
        of(window).outside_ = !entered;
        leave(window);
        if (!entered) return;
        // GLFW tells of no move to where the pointer has been before.
        of(window).pointer_.reset();
        add(window, Kind::move);
    }
    /// A drag goes on outside until its button comes up.
    static void leave(GLFWwindow* window) {
        if (of(window).outside_ && of(window).buttons_ == 0) add(window, Kind::leave);
    }
    static void scroll(GLFWwindow* window, double x, double y) { add(window, Kind::scroll).scroll = {x, y}; }
    static void key(GLFWwindow* window, int key, int scancode, int action, int mods) {
        // Moves and letters come without modifiers, and a modifier's own event says how it was before.
        of(window).modifiers_ = modifiers_after(key, action != GLFW_RELEASE, mods);
        InputEvent& event = add(window, action == GLFW_RELEASE ? Kind::key_up : Kind::key_down);
        KeyCodes& codes = of(window).key_codes_;
        event.key = action == GLFW_RELEASE ? codes.up(key)
                                           : codes.down(key, glfw().glfwGetKeyName(key, scancode), mods);
        event.repeat = of(window).repeats_ = action == GLFW_REPEAT;
    }
    static void text(GLFWwindow* window, unsigned code) {
        InputEvent& event = add(window, Kind::text);
        event.code = code;
        event.repeat = of(window).repeats_;  // The key's own event comes first.
    }
    static void drop(GLFWwindow* window, int count, const char** paths) {
        add(window, Kind::drop).paths.assign(paths, paths + count);
    }
    static void focus(GLFWwindow* window, int focused) {
        of(window).modifiers_ = of(window).buttons_ = 0;
        if (!focused) add(window, Kind::focus_lost);
    }
    static void refresh(GLFWwindow* window) { of(window).needs_present_ = true; }
};

Window::Window(const std::string& title, Vec2i size) {
    const GlfwLock lock;
    const Glfw& f = GlfwLock::functions();
    // Xlib tells of a broken connection when it next reads; glfwCreateWindow() would go on without one.
    f.glfwPollEvents();
    require_display();
    f.glfwDefaultWindowHints();
    // EGL as everywhere else in the library, so that one process never mixes two ways to make contexts.
    f.glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    f.glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    f.glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    f.glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    f.glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);  // show() does it.
    // The size is meant in plain pixels, as the panels' is: on a HiDPI screen the window has more.
    f.glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = f.glfwCreateWindow(size.x(), size.y(), title.c_str(), nullptr, nullptr);
    if (!window_) {
        const char* reason = nullptr;
        f.glfwGetError(&reason);
        throw ContextError(fmt::format("no window: {}", reason ? reason : "it cannot be made"));
    }
    f.glfwSetWindowUserPointer(window_, this);
    f.glfwSetInputMode(window_, GLFW_LOCK_KEY_MODS, GLFW_TRUE);  // Num Lock
    f.glfwSetCursorPosCallback(window_, WindowCallbacks::move);
    f.glfwSetCursorEnterCallback(window_, WindowCallbacks::enter);
    f.glfwSetMouseButtonCallback(window_, WindowCallbacks::button);
    f.glfwSetScrollCallback(window_, WindowCallbacks::scroll);
    f.glfwSetKeyCallback(window_, WindowCallbacks::key);
    f.glfwSetCharCallback(window_, WindowCallbacks::text);
    f.glfwSetDropCallback(window_, WindowCallbacks::drop);
    f.glfwSetWindowFocusCallback(window_, WindowCallbacks::focus);
    f.glfwSetWindowRefreshCallback(window_, WindowCallbacks::refresh);
    show();
}

void Window::show() {
    const Glfw& f = glfw();
    // GLFW 3.3 waits without end for a window that is not mapped while other events lie unread.
    f.glfwPollEvents();
    f.glfwShowWindow(window_);
    is_shown_ = f.glfwGetWindowAttrib(window_, GLFW_VISIBLE);
    asked_to_show_ = now();
}

Window::~Window() {
    const GlfwLock lock;
    // On a lost display there is nothing to destroy, and GLFW would wait for answers.
    if (!display_is_lost()) glfw().glfwDestroyWindow(window_);
}

bool Window::poll_events() {
    const GlfwLock lock;
    glfw().glfwPollEvents();
    return !events_.empty();
}

bool Window::has_input() noexcept {
    constexpr double look_seconds = 0.005;
    const double time = now();
    if (input_waits_ || time - looked_ < look_seconds) return input_waits_;
    looked_ = time;
    try {
        const GlfwLock lock;
        if (!display_is_lost()) poll_events();
        input_waits_ = std::ranges::any_of(events_, [](const InputEvent& event) {
            return event.kind == Kind::press || event.kind == Kind::scroll || event.kind == Kind::key_down;
        });
    } catch (...) {
        // events() meets it again, and tells.
    }
    return input_waits_;
}

std::vector<InputEvent> Window::events(double seconds) {
    require_display();
    // What lies in GLFW's own queue does not show on the connection.
    if (seconds > 0 && !poll_events() && wait_for_display(seconds)) seconds = 0;
    {
        const GlfwLock lock;
        if (seconds > 0 && events_.empty())
            glfw().glfwWaitEventsTimeout(seconds);
        else
            glfw().glfwPollEvents();
        require_display();
        // A window manager that is just starting may lose the request to map a window.
        if (!is_shown_) is_shown_ = glfw().glfwGetWindowAttrib(window_, GLFW_VISIBLE);
        if (!is_shown_ && now() > asked_to_show_ + ask_again_seconds) show();
    }
    // Whoever asked for the mutex meanwhile gets it before this thread waits again.
    if (waiting_threads > 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    const GlfwLock lock;
    input_waits_ = false;
    return std::exchange(events_, {});
}

Vec2i Window::size() const {
    const GlfwLock lock;
    Vec2i size(0, 0);
    glfw().glfwGetFramebufferSize(window_, &size.x(), &size.y());
    require_display();  // Without one GLFW leaves numbers that mean nothing.
    return size;
}

float Window::scale() const {
    const GlfwLock lock;
    float x = 1, y = 1;
    glfw().glfwGetWindowContentScale(window_, &x, &y);
    return x;
}

bool Window::should_close() const {
    const GlfwLock lock;
    return glfw().glfwWindowShouldClose(window_);
}

void Window::make_target(Vec2i size) {
    if (size == target_size_) return;
    if (!texture_) {
        glGenTextures(1, &texture_);
        glGenFramebuffers(1, &framebuffer_);
    }
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x(), size.y(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    target_size_ = size;
}

void Window::present(const Image& picture) {
    const GlfwLock lock;
    const Glfw& f = glfw();
    f.glfwMakeContextCurrent(window_);
    f.glfwSwapInterval(0);  // Pictures are paced by update(); waiting here would hold the mutex.
    make_target({picture.width(), picture.height()});
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, picture.width(), picture.height(), GL_RGBA, GL_UNSIGNED_BYTE,
                    picture.bytes().data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    const Vec2i to = size();
    // The window's first row is the lowest.
    glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, to.y(), to.x(), 0, GL_COLOR_BUFFER_BIT,
                      to == target_size_ ? GL_NEAREST : GL_LINEAR);
    f.glfwSwapBuffers(window_);
    f.glfwMakeContextCurrent(nullptr);
    needs_present_ = false;
}

std::string Window::clipboard() const {
    const GlfwLock lock;
    // GLFW 3.3 waits without end for an owner that does not answer.
    if (const char* display = display_name())
        return read_clipboard(display, clipboard_seconds, glfw().glfwPollEvents);
    const char* text = glfw().glfwGetClipboardString(window_);
    return text ? text : "";
}

void Window::set_clipboard(const std::string& text) {
    const GlfwLock lock;
    glfw().glfwSetClipboardString(window_, text.c_str());
}

void Window::set_title(const std::string& title) {
    const GlfwLock lock;
    glfw().glfwSetWindowTitle(window_, title.c_str());
}

}  // namespace easypbr::gui
