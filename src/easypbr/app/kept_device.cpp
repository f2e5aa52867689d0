#include "easypbr/app/kept_device.h"

#include <fmt/format.h>

#include "easypbr/core/log.h"

namespace easypbr::app {

const gl::ContextInfo& KeptDevice::info() {
    if (!state_->device->context) state_->device->context = gl::Context::create(state_->asked);
    return state_->device->context->info();
}

void KeptDevice::ask_for(DrawDevice device) {
    if (state_->device->context && device != DrawDevice::automatic && device != info().device)
        throw ArgumentError(
            fmt::format("device: pictures have been drawn by {} already; expected it to be set "
                        "before the first one",
                        draw_device_names()[size_t(info().device)]));
    state_->asked = device;
}

void KeptDevice::refuse_nested() {
    throw ArgumentError(
        "this viewer is drawing: expected its passes, and sinks of log and progress, to draw no other "
        "picture of it");
}

bool KeptDevice::is_current() const {
    return state_->device->context && gl::Context::current_or_null() == state_->device->context.get();
}

bool KeptDevice::is_stuck() const {
    return is_current() && state_->device->context->is_lost();
}

void KeptDevice::replace_lost() {
    if (!is_current() && state_->device->context && state_->device->context->is_lost())
        replace("the OpenGL context was lost");
}

std::string KeptDevice::loss(const Error& error) const {
    if (dynamic_cast<const gl::ContextLost*>(&error)) return error.what();
    // None could be made in place of one that was lost.
    if (!state_->device->context) return state_->losses > 0 ? error.what() : "";
    try {
        const gl::ContextScope scope(*state_->device->context);
        gl::Context::check();
        return "";
    } catch (const gl::ContextLost& lost) {
        return lost.what();
    }
}

void KeptDevice::replace(const std::string& reason) {
    const bool by_gl = !state_->device->context || state_->device->context->info().device == DrawDevice::gl;
    const bool falls_back = ++state_->losses == 2 && by_gl && state_->asked == DrawDevice::automatic;
    state_->device = std::make_shared<Device>();
    ++state_->number;
    if (state_->losses > 1 && !falls_back) {
        state_->losses = 0;
        throw gl::ContextLost(fmt::format("{}, and so was the one made in its place", reason));
    }
    if (falls_back) state_->asked = DrawDevice::cpu;
    log_warning(
        fmt::format("{}; {}", reason,
                    falls_back ? "from now on the CPU draws" : "everything is drawn again in another one"));
}

}  // namespace easypbr::app
