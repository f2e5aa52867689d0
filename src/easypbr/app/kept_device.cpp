#include "easypbr/app/kept_device.h"

#include <fmt/format.h>

#include "easypbr/core/log.h"

namespace easypbr::app {

const gl::ContextInfo& KeptDevice::info() {
    if (!device_->context) device_->context = gl::Context::create(asked_);
    return device_->context->info();
}

void KeptDevice::ask_for(DrawDevice device) {
    if (device_->context && device != DrawDevice::automatic && device != info().device)
        throw ArgumentError(
            fmt::format("device: pictures have been drawn by {} already; expected it to be set "
                        "before the first one",
                        draw_device_names()[size_t(info().device)]));
    asked_ = device;
}

bool KeptDevice::is_current() const {
    return device_->context && gl::Context::current_or_null() == device_->context.get();
}

bool KeptDevice::is_stuck() const {
    return is_current() && device_->context->is_lost();
}

void KeptDevice::replace_lost() {
    if (!is_current() && device_->context && device_->context->is_lost())
        replace("the OpenGL context was lost");
}

std::string KeptDevice::loss(const Error& error) const {
    if (dynamic_cast<const gl::ContextLost*>(&error)) return error.what();
    // None could be made in place of one that was lost.
    if (!device_->context) return losses_ > 0 ? error.what() : "";
    try {
        const gl::ContextScope scope(*device_->context);
        gl::Context::check();
        return "";
    } catch (const gl::ContextLost& lost) {
        return lost.what();
    }
}

void KeptDevice::replace(const std::string& reason) {
    const bool by_gl = !device_->context || device_->context->info().device == DrawDevice::gl;
    const bool falls_back = ++losses_ == 2 && by_gl && asked_ == DrawDevice::automatic;
    device_ = std::make_shared<Device>();
    ++number_;
    if (losses_ > 1 && !falls_back) {
        losses_ = 0;
        throw gl::ContextLost(fmt::format("{}, and so was the one made in its place", reason));
    }
    if (falls_back) asked_ = DrawDevice::cpu;
    log_warning(
        fmt::format("{}; {}", reason,
                    falls_back ? "from now on the CPU draws" : "everything is drawn again in another one"));
}

}  // namespace easypbr::app
