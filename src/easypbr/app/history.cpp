#include "easypbr/app/history.h"

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/scene/fields.h"

namespace easypbr::app {

bool same_choices(const Settings& a, const Settings& b) {
    return std::ranges::all_of(fields(), [&](const Field& field) {
        const Value x = field.get(a), y = field.get(b);
        return x.state == y.state && (x.state != Value::State::given || x.data == y.data);
    });
}

void History::note(const Settings& settings) {
    if (!states_.empty() && same_choices(states_[present_], settings)) return;
    if (!states_.empty()) states_.resize(present_ + 1);
    states_.push_back(settings);
    if (states_.size() > most_states) states_.erase(states_.begin());
    present_ = states_.size() - 1;
}

const Settings& History::undo() {
    if (!can_undo()) throw ArgumentError("nothing to undo");
    return states_[--present_];
}

const Settings& History::redo() {
    if (!can_redo()) throw ArgumentError("nothing to redo");
    return states_[++present_];
}

}  // namespace easypbr::app
