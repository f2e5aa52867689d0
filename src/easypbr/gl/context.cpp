#include "easypbr/gl/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/variable.h"
#include "easypbr/gl/draw.h"
#include "easypbr/gl/object.h"

namespace easypbr::gl {
namespace {

thread_local Context* current_context = nullptr;

/// A display worth trying, by the name a person knows it under.
struct Candidate {
    std::string what;
    EGLDisplay display = EGL_NO_DISPLAY;
};

/// The name of an EGL error code, for people who look it up.
const char* egl_error_name(EGLint code) {
    constexpr const char* names[] = {"EGL_SUCCESS",       "EGL_NOT_INITIALIZED",     "EGL_BAD_ACCESS",
                                     "EGL_BAD_ALLOC",     "EGL_BAD_ATTRIBUTE",       "EGL_BAD_CONFIG",
                                     "EGL_BAD_CONTEXT",   "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
                                     "EGL_BAD_MATCH",     "EGL_BAD_NATIVE_PIXMAP",   "EGL_BAD_NATIVE_WINDOW",
                                     "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",         "EGL_CONTEXT_LOST"};
    const int index = code - EGL_SUCCESS;
    return index >= 0 && index < int(std::size(names)) ? names[index] : "an unknown error";
}

std::string egl_error(const char* call) {
    const EGLint code = eglGetError();
    return fmt::format("{} failed: {} (0x{:04x})", call, egl_error_name(code), code);
}

bool has_extension(const char* list, const char* name) {
    if (!list) return false;
    const size_t length = std::strlen(name);
    for (const char* at = list; (at = std::strstr(at, name)); at += length)
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
    return false;
}

/// libepoxy ends the process when a library is missing, so that is found out first.
void require_libraries() {
    if (!dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL))
        throw ContextError(
            "no OpenGL context: libEGL.so.1 is not installed. Install 'libegl1 libegl-mesa0 libgl1-mesa-dri' "
            "(Debian), or the driver of your GPU");
    if (!dlopen("libOpenGL.so.0", RTLD_LAZY | RTLD_GLOBAL) && !dlopen("libGL.so.1", RTLD_LAZY | RTLD_GLOBAL))
        throw ContextError(
            "no OpenGL context: neither libOpenGL.so.0 nor libGL.so.1 is installed. Install 'libopengl0'");
}

/// The number of the one EGL device that the environment asks for.
std::optional<int> device_by_number() {
    const std::optional<std::string> text = variable("EASYPBR_EGL_DEVICE");
    if (!text) return std::nullopt;
    const int number = whole_number(*text).value_or(-1);
    if (number < 0)
        throw ContextError(fmt::format(
            "EASYPBR_EGL_DEVICE: expected the number of an EGL device, from 0 on, got '{}'", *text));
    return number;
}

/// In EGL's order.
std::vector<EGLDeviceEXT> egl_devices(const char* client_extensions) {
    std::vector<EGLDeviceEXT> devices(32);
    EGLint count = 0;
    if (!has_extension(client_extensions, "EGL_EXT_platform_device") ||
        !eglQueryDevicesEXT(EGLint(devices.size()), devices.data(), &count))
        count = 0;
    devices.resize(size_t(count));
    return devices;
}

std::vector<Candidate> device_candidates(const char* client_extensions) {
    std::vector<Candidate> hardware, software;
    const std::vector<EGLDeviceEXT> devices = egl_devices(client_extensions);
    const std::optional<int> asked = device_by_number();
    if (asked && size_t(*asked) >= devices.size())
        throw ContextError(fmt::format("EASYPBR_EGL_DEVICE: there is no EGL device {}: there are {}", *asked,
                                       devices.size()));
    for (size_t i = 0; i < devices.size(); ++i) {
        if (asked && i != size_t(*asked)) continue;
        const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        const bool is_software = has_extension(extensions, "EGL_MESA_device_software");
        Candidate candidate{fmt::format("EGL device {}{}", i, is_software ? " (software)" : "")};
        candidate.display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
        (is_software ? software : hardware).push_back(candidate);
    }
    hardware.insert(hardware.end(), software.begin(), software.end());
    return hardware;
}

std::vector<Candidate> candidates() {
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    std::vector<Candidate> found = device_candidates(extensions);
    if (device_by_number()) return found;
    if (has_extension(extensions, "EGL_MESA_platform_surfaceless"))
        found.push_back({"EGL surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                                                     EGL_DEFAULT_DISPLAY, nullptr)});
    found.push_back({"EGL default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
    return found;
}

/// Whether the environment asks for all that drivers say, each message at the call that it is of.
bool is_debugging() {
    const char* value = std::getenv("EASYPBR_GL_DEBUG");
    return value && *value && std::strcmp(value, "0") != 0;
}

/// Makes a 4.5 core context; EGL_NO_CONTEXT where the driver does not.
EGLContext create_context(EGLDisplay display, std::initializer_list<EGLint> more) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       4,
                                   EGL_CONTEXT_MINOR_VERSION,       5,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    // Left out unless it is asked for: EGL 1.4 may not know it.
    if (is_debugging())
        attributes.insert(attributes.end(), {EGL_CONTEXT_FLAGS_KHR, EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR});
    attributes.insert(attributes.end(), more);
    attributes.push_back(EGL_NONE);
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
}

/// Makes a 4.5 core context on the display, that tells of resets if it can; returns EGL_NO_CONTEXT and the
/// reason in `error`.
EGLContext try_display(EGLDisplay display, std::string& error) {
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) {
        error = egl_error("eglInitialize");
        return EGL_NO_CONTEXT;
    }
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"})
        if (!has_extension(extensions, needed)) {
            error = fmt::format("{} is missing", needed);
            return EGL_NO_CONTEXT;
        }
    if (!eglBindAPI(EGL_OPENGL_API)) {
        error = egl_error("eglBindAPI(OpenGL)");
        return EGL_NO_CONTEXT;
    }
    // Not every driver tells of resets.
    EGLContext context = create_context(
        display, {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR, EGL_LOSE_CONTEXT_ON_RESET_KHR});
    if (context == EGL_NO_CONTEXT) context = create_context(display, {});
    if (context == EGL_NO_CONTEXT) error = egl_error("eglCreateContext for OpenGL 4.5 core");
    return context;
}

[[noreturn]] void fail_without_context(const std::vector<Attempt>& attempts) {
    std::string message = "no OpenGL 4.5 context:";
    for (const Attempt& attempt : attempts) message += fmt::format(" [{}: {}]", attempt.what, attempt.error);
    message +=
        ". Install the driver of your GPU, or Mesa's software renderer: libegl1 libegl-mesa0 libgl1-mesa-dri";
    throw ContextError(message);
}

/// Errors of the driver become warnings, what it says of performance messages for developers; the exception
/// of the failing operation follows from its own checks.
void GLAPIENTRY debug_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                              const GLchar* text, const void*) {
    // Program throws what compilers say.
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
    if (type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH)
        log_warning(fmt::format("OpenGL: {}", std::string_view(text, size_t(length))));
    else if (type == GL_DEBUG_TYPE_PERFORMANCE)
        log(LogLevel::debug, fmt::format("OpenGL performance: {}", std::string_view(text, size_t(length))));
}

/// Why a context is lost, in words.
const char* reset_reason(GLenum status) {
    switch (status) {
        case GL_GUILTY_CONTEXT_RESET:
            return "the GPU was reset because of what was drawn";
        case GL_INNOCENT_CONTEXT_RESET:
            return "the GPU was reset, and not because of what was drawn";
        default:
            return "the GPU was reset";
    }
}

std::string gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text ? reinterpret_cast<const char*>(text) : "";
}

/// Largest side of what is drawn in one piece without the driver: as llvmpipe's.
constexpr int native_limit = 1 << 14;

/// Whether there may be a GPU: without a device file there is none, and nothing has to be loaded to know
/// that.
bool has_gpu_files() {
    for (const char* file :
         {"/dev/dri", "/dev/nvidiactl", "/dev/nvidia0", "/dev/dxg", "/dev/kfd", "/dev/mali0"})
        if (::access(file, F_OK) == 0) return true;
    return false;
}

DrawDevice device_by_environment() {
    const std::optional<std::string> name = variable("EASYPBR_DEVICE");
    try {
        return name ? draw_device_named(*name) : DrawDevice::automatic;
    } catch (const NameError& error) {
        throw ContextError(fmt::format("EASYPBR_DEVICE: {}", error.what()));
    }
}

}  // namespace

std::unique_ptr<Context> Context::create(DrawDevice device) {
    // Drivers keep threads and locks of their own, which a forked child does not have.
    static const pid_t first_process = getpid();
    if (first_process != getpid())
        throw ContextError(
            "this process was forked from one that had already drawn: start workers with 'spawn' instead");
    thread_count();  // A wrong EASYPBR_THREADS is told before anything is drawn.
    if (device == DrawDevice::automatic) device = device_by_environment();
    if (device == DrawDevice::automatic && device_by_number()) device = DrawDevice::gl;
    const bool asked = device != DrawDevice::automatic;
    if (!asked) device = has_gpu_files() ? DrawDevice::gl : DrawDevice::cpu;
    std::unique_ptr<Context> made(new Context);
    made->info_.device = device;
    if (device == DrawDevice::gl) {
        try {
            const ContextScope scope(*made);
            made->load_driver();
            if (!asked && made->info_.software) made->info_.device = DrawDevice::cpu;
            return made;
        } catch (const ContextError&) {
            if (asked) throw;
            made->info_.device = DrawDevice::cpu;
        }
    }
    made->info_.software = true;
    made->info_.max_texture_size = made->info_.max_viewport = native_limit;
    return made;
}

void Context::load_driver() {
    require_libraries();
    std::vector<Attempt>& attempts = info_.attempts;
    attempts.clear();
    for (const Candidate& candidate : candidates()) {
        attempts.push_back({candidate.what, {}});
        context_ = try_display(candidate.display, attempts.back().error);
        if (context_ == EGL_NO_CONTEXT) continue;
        display_ = candidate.display;
        info_.platform = candidate.what;
        scope_->enter(*this);
        initialize();
        return;
    }
    fail_without_context(attempts);
}

void Context::initialize() {
    info_.vendor = gl_string(GL_VENDOR);
    info_.renderer = gl_string(GL_RENDERER);
    info_.version = gl_string(GL_VERSION);
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR"})
        info_.software |= info_.device == DrawDevice::cpu || info_.renderer.find(name) != std::string::npos;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info_.max_texture_size);
    GLint viewport[2] = {0, 0};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    info_.max_viewport = std::min(viewport[0], viewport[1]);
    glDebugMessageCallback(debug_message, nullptr);
    glEnable(GL_DEBUG_OUTPUT);
    if (is_debugging()) glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    reset_state();
}

Context::Context() : process_(getpid()), deletions_(std::make_shared<DeletionQueue>()) {}

Context::~Context() {
    deletions_->close();
    // A forked child shares the driver's state with its parent and must leave it alone.
    if (context_ && process_ == getpid()) eglDestroyContext(display_, context_);
}

const VertexArray& Context::no_attributes() {
    if (!no_attributes_) no_attributes_ = VertexArray::make();
    return no_attributes_;
}

Context* Context::current_or_null() {
    return current_context;
}

Context& Context::current() {
    if (!current_context) throw ContextError("an OpenGL object was made outside of a ContextScope");
    return *current_context;
}

Context& Context::with_driver() {
    Context& context = current();
    if (!context.context_) {
        try {
            context.load_driver();
        } catch (const ContextError& error) {
            throw ContextError(
                fmt::format("this needs OpenGL, beyond what the CPU draws natively: {}", error.what()));
        }
    }
    return context;
}

void Context::check() {
    if (!has_driver()) return;
    Context& context = *current_context;
    const GLenum status = context.lost_ ? GL_UNKNOWN_CONTEXT_RESET : glGetGraphicsResetStatus();
    if (status == GL_NO_ERROR) return;
    context.lost_ = true;
    throw ContextLost(fmt::format("the OpenGL context was lost: {}", reset_reason(status)));
}

bool Context::has_driver() {
    return current_context && current_context->context_;
}

void forget_errors() {
    constexpr int most = 64;  // More than the kinds of errors, each of which is noted once.
    for (int i = 0; i < most && glGetError() != GL_NO_ERROR; ++i) {
    }
}

ContextScope::ContextScope(Context& context) : previous_(current_context) {
    if (context.process_ != getpid())
        throw ContextError(
            "the viewer was made before this process was forked: start workers with 'spawn' instead");
    lock_ = std::unique_lock(context.mutex_);
    if (previous_ == &context) return;
    if (context.context_) enter(context);
    switched_ = true;
    outer_ = std::exchange(context.scope_, this);
    current_context = &context;
    if (entered_) context.deletions_->flush();
}

void ContextScope::enter(Context& context) {
    old_display_ = eglGetCurrentDisplay();
    old_context_ = eglGetCurrentContext();
    old_draw_ = eglGetCurrentSurface(EGL_DRAW);
    old_read_ = eglGetCurrentSurface(EGL_READ);
    eglBindAPI(EGL_OPENGL_API);
    if (!eglMakeCurrent(context.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_)) {
        const std::string message = egl_error("eglMakeCurrent");
        if (message.find("EGL_CONTEXT_LOST") == message.npos) throw ContextError(message);
        context.lost_ = true;
        throw ContextLost(fmt::format("the OpenGL context was lost: {}", message));
    }
    entered_ = true;
}

ContextScope::~ContextScope() {
    if (!switched_) return;
    Context& context = *current_context;
    current_context = previous_;
    context.scope_ = outer_;
    if (!entered_) return;
    if (old_context_ != EGL_NO_CONTEXT)
        eglMakeCurrent(old_display_, old_draw_, old_read_, old_context_);
    else
        eglMakeCurrent(context.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace easypbr::gl
