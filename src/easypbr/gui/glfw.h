// GLFW, loaded when the first window is opened: the library itself starts on machines that have neither GLFW
// nor a display.
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <mutex>

namespace easypbr::gui {

#define EASYPBR_GLFW_FUNCTIONS(X)                                                                           \
    X(glfwInit)                                                                                             \
    X(glfwGetError)                                                                                         \
    X(glfwWindowHint)                                                                                       \
    X(glfwDefaultWindowHints)                                                                               \
    X(glfwCreateWindow)                                                                                     \
    X(glfwDestroyWindow)                                                                                    \
    X(glfwMakeContextCurrent)                                                                               \
    X(glfwSwapBuffers) X(glfwSwapInterval) X(glfwPollEvents) X(glfwWaitEventsTimeout) X(glfwPostEmptyEvent) \
        X(glfwWindowShouldClose) X(glfwSetWindowUserPointer) X(glfwGetWindowUserPointer)                    \
            X(glfwGetFramebufferSize) X(glfwGetWindowSize) X(glfwGetWindowContentScale)                     \
                X(glfwSetWindowTitle) X(glfwGetClipboardString) X(glfwSetClipboardString)                   \
                    X(glfwSetCursorPosCallback) X(glfwSetMouseButtonCallback) X(glfwSetScrollCallback)      \
                        X(glfwSetKeyCallback) X(glfwSetCharCallback) X(glfwSetDropCallback)                 \
                            X(glfwSetWindowFocusCallback) X(glfwSetWindowRefreshCallback)                   \
                                X(glfwGetCursorPos) X(glfwGetKeyName) X(glfwInitHint) X(glfwShowWindow)     \
                                    X(glfwGetWindowAttrib) X(glfwSetInputMode) X(glfwSetCursorEnterCallback)

/// Its functions.
struct Glfw {
#define EASYPBR_DECLARE(name) decltype(&::name) name = nullptr;
    EASYPBR_GLFW_FUNCTIONS(EASYPBR_DECLARE)
#undef EASYPBR_DECLARE
};

/// Loads and starts GLFW at the first call. Throws ContextError that says what is missing: the library, or a
/// display. The mutex below must be held.
const Glfw& glfw();

/// GLFW serves one thread at a time; whoever calls it holds this.
std::recursive_mutex& glfw_mutex();

}  // namespace easypbr::gui
