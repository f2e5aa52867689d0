#include "easypbr/core/interrupt.h"

#include <utility>

namespace easypbr {
namespace {

thread_local const InterruptScope* current = nullptr;

}  // namespace

InterruptScope::InterruptScope(std::function<bool()> stop)
    : stop_(std::move(stop)), outer_(std::exchange(current, this)) {}

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
