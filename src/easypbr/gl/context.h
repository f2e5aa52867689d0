// OpenGL 4.5 contexts without a window: EGL device (a real GPU first), surfaceless, software. Where the CPU
// draws natively, the driver is loaded when something needs it.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/picture.h"
#include "easypbr/gl/buffer.h"

namespace easypbr::gl {

/// The driver has lost a context and all that was in it, as after a reset of the GPU. Another one can be
/// made.
class ContextLost : public ContextError {
  public:
    using ContextError::ContextError;
};

/// What was tried on the way to a context, in order; `error` is empty for the one that worked.
struct Attempt {
    std::string what;
    std::string error;
};

struct ContextInfo {
    DrawDevice device = DrawDevice::gl;               ///< never automatic
    std::string vendor, renderer, version, platform;  ///< of the driver; empty until it is loaded
    bool software = false;                            ///< the CPU draws, natively where it can
    int max_texture_size = 0;
    int max_viewport = 0;
    std::vector<Attempt> attempts;
};

class DeletionQueue;
class ContextScope;

/// One OpenGL 4.5 core context. May be used from any thread, by one at a time: through ContextScope.
class Context {
  public:
    /// Throws ContextError that lists what was tried, why each failed and what to install; for the CPU only
    /// in a forked process.
    static std::unique_ptr<Context> create(DrawDevice device = DrawDevice::gl);

    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const ContextInfo& info() const { return info_; }

    /// The context that is current on this thread through a ContextScope. Throws ContextError when there is
    /// none.
    static Context& current();
    /// The same, or null.
    static Context* current_or_null();
    /// The same, with the driver loaded. Throws ContextError when that fails.
    static Context& with_driver();
    /// Whether OpenGL may be called: the driver of the current context is loaded.
    static bool has_driver();

    /// Asks the driver of the current context whether it is lost. Throws ContextLost that says why; nothing
    /// without a driver.
    static void check();
    /// Whether that has been found out: nothing can be drawn in it any more.
    bool is_lost() const { return lost_; }

    /// GL objects that died while the context was not current wait here.
    const std::shared_ptr<DeletionQueue>& deletions() const { return deletions_; }

    /// For draws without vertex attributes. This context is current.
    const VertexArray& no_attributes();

  private:
    friend class ContextScope;
    Context();
    void load_driver();
    void initialize();

    void* display_ = nullptr;
    void* context_ = nullptr;
    long process_ = 0;
    std::atomic<bool> lost_{false};
    ContextInfo info_;
    std::recursive_mutex mutex_;
    ContextScope* scope_ = nullptr;  ///< that made it current
    std::shared_ptr<DeletionQueue> deletions_;
    VertexArray no_attributes_;
};

/// Makes a context current for a scope and gives back what was current before. Nested scopes are fine; a
/// second thread waits. Throws ContextError in a process forked after the context was made.
class ContextScope {
  public:
    explicit ContextScope(Context& context);
    ~ContextScope();
    ContextScope(const ContextScope&) = delete;
    ContextScope& operator=(const ContextScope&) = delete;

  private:
    friend class Context;
    /// Makes the driver's context current. Throws ContextLost.
    void enter(Context& context);

    std::unique_lock<std::recursive_mutex> lock_;
    Context* previous_;
    ContextScope* outer_ = nullptr;  ///< of the same context
    bool switched_ = false, entered_ = false;
    void *old_display_ = nullptr, *old_context_ = nullptr, *old_draw_ = nullptr, *old_read_ = nullptr;
};

/// Drops the errors that the driver has noted. A lost context notes them without end.
void forget_errors();

}  // namespace easypbr::gl
