// Of Session: contexts that the driver loses.
#include "easypbr/app/session.h"

namespace easypbr::app {

gl::Context& Session::context() {
    if (!is_current()) replace_lost_device();
    renderer();
    return *device_->context;
}

bool Session::is_current() const {
    return device_->context && gl::Context::current_or_null() == device_->context.get();
}

bool Session::is_stuck() const {
    return is_current() && device_->context->is_lost();
}

std::string Session::loss(const Error& error) const {
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

void Session::replace_lost_device() {
    if (device_->context && device_->context->is_lost()) replace_device("the OpenGL context was lost");
}

}  // namespace easypbr::app
