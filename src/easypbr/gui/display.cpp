#include "easypbr/gui/display.h"

#include <dlfcn.h>
#include <poll.h>

#include <atomic>
#include <cmath>

#include "easypbr/core/error.h"

namespace easypbr::gui {
namespace {

/// Xlib's types and functions, found at run time: its headers would be needed for nothing else.
struct Display;
using IoErrorHandler = int (*)(Display*);
using ExitHandler = void (*)(Display*, void*);

Display* display = nullptr;
const char* name_of_display = nullptr;
std::atomic<int> connection = -1;
std::atomic<bool> lost = false;
IoErrorHandler handler_before = nullptr;

/// Takes the place of the handler that prints.
int on_io_error(Display* which) {
    return which == display || !handler_before ? 0 : handler_before(which);
}

/// Takes the place of exit().
void on_exit(Display*, void*) {
    lost = true;
}

template <class Function>
Function find(void* library, const char* name) {
    return reinterpret_cast<Function>(dlsym(library, name));
}

}  // namespace

void watch_display() {
    void* glfw_library = dlopen("libglfw.so.3", RTLD_NOW | RTLD_NOLOAD);
    void* x11 = dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
    if (!glfw_library || !x11) return;
    const auto get_display = find<Display* (*)()>(glfw_library, "glfwGetX11Display");
    const auto number = find<int (*)(Display*)>(x11, "XConnectionNumber");
    const auto name = find<const char* (*)(Display*)>(x11, "XDisplayString");
    const auto set_exit = find<void (*)(Display*, ExitHandler, void*)>(x11, "XSetIOErrorExitHandler");
    const auto set_handler = find<IoErrorHandler (*)(IoErrorHandler)>(x11, "XSetIOErrorHandler");
    if (!get_display || !number || !name || !set_exit || !set_handler) return;
    display = get_display();
    if (!display) return;
    name_of_display = name(display);
    set_exit(display, on_exit, nullptr);
    handler_before = set_handler(on_io_error);
    connection = number(display);
}

bool display_is_lost() {
    return lost;
}

void require_display() {
    if (lost)
        throw ContextError(
            "the display that the window was on has gone away; pictures can be drawn and recorded without "
            "one, windows need a new process");
}

bool wait_for_display(double seconds) {
    if (connection < 0) return false;
    pollfd file{connection, POLLIN, 0};
    poll(&file, 1, int(std::ceil(seconds * 1000)));
    return true;
}

const char* display_name() {
    return name_of_display;
}

}  // namespace easypbr::gui
