#include "easypbr/gui/glfw.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include "easypbr/core/error.h"
#include "easypbr/gui/display.h"

namespace easypbr::gui {
namespace {

constexpr const char* without_window = "without a window, render() gives arrays and record() writes files";

Glfw load() {
    void* library = dlopen("libglfw.so.3", RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw ContextError(
            fmt::format("no window: libglfw.so.3 cannot be loaded ({}). Install 'libglfw3' (Debian); {}",
                        dlerror(), without_window));
    Glfw functions;
#define EASYPBR_LOAD(name)                                                              \
    functions.name = reinterpret_cast<decltype(functions.name)>(dlsym(library, #name)); \
    if (!functions.name) throw ContextError("no window: libglfw.so.3 has no function " #name);
    EASYPBR_GLFW_FUNCTIONS(EASYPBR_LOAD)
#undef EASYPBR_LOAD
    return functions;
}

}  // namespace

std::recursive_mutex& glfw_mutex() {
    static std::recursive_mutex mutex;
    return mutex;
}

const Glfw& glfw() {
    static const Glfw functions = load();
    // Asked for again after a failure: a display may have come.
    static bool started = false;
    if (!started && !functions.glfwInit()) {
        const char* reason = nullptr;
        functions.glfwGetError(&reason);
        throw ContextError(
            fmt::format("no window: {}; {}", reason ? reason : "GLFW does not start", without_window));
    }
    if (!started) watch_display();
    started = true;
    return functions;
}

}  // namespace easypbr::gui
