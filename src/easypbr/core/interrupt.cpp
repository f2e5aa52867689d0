#include "easypbr/core/interrupt.h"

#include <utility>

namespace easypbr {
namespace {

thread_local const InterruptScope* current = nullptr;

}  // namespace

InterruptScope::InterruptScope(std::function<bool()> stop, bool also_outer)
    : stop_(std::move(stop)), also_outer_(also_outer), outer_(std::exchange(current, this)) {}

InterruptScope::~InterruptScope() {
    current = outer_;
}

void check_interrupt() {
    if (current && current->is_stopped()) throw Interrupted();
}

bool can_be_interrupted() {
    return current;
}

}  // namespace easypbr
