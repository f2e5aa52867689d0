#include "easypbr/gl/pace.h"

#include <epoxy/gl.h>

#include <utility>

#include "easypbr/core/interrupt.h"
#include "easypbr/gl/context.h"

namespace easypbr::gl {
namespace {

void wait_for(const Object& fence) {
    constexpr GLuint64 patience = 20'000'000;  // nanoseconds between two looks
    while (glClientWaitSync(static_cast<GLsync>(fence.pointer()), GL_SYNC_FLUSH_COMMANDS_BIT, patience) ==
           GL_TIMEOUT_EXPIRED)
        check_interrupt();
}

}  // namespace

void Pace::step() {
    check_interrupt();
    if (!can_be_interrupted() || !Context::has_driver()) return;
    const Object before = std::exchange(fence_, Object(ObjectKind::fence));
    if (before) wait_for(before);
}

void wait_for_driver() {
    check_interrupt();
    if (can_be_interrupted() && Context::has_driver()) wait_for(Object(ObjectKind::fence));
}

}  // namespace easypbr::gl
