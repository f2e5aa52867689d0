#include "easypbr/app/history.h"

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

bool same_choice(const Value& a, const Value& b) {
    return a.state == b.state && (a.state != Value::State::given || a.data == b.data);
}

std::vector<std::pair<std::string, Value>> changed_choices(const Settings& before, const Settings& now) {
    std::vector<std::pair<std::string, Value>> changed;
    for (const Field& field : fields()) {
        if (field.same(before, now)) continue;
        Value x = field.get(before), y = field.get(now);
        if (!same_choice(x, y)) changed.emplace_back(field.name, std::move(y));
    }
    return changed;
}

bool same_choices(const Settings& a, const Settings& b) {
    return std::ranges::all_of(fields(), [&](const Field& field) {
        return field.same(a, b) || same_choice(field.get(a), field.get(b));
    });
}

bool History::is_present(const Settings& settings, const Choices& choices) const {
    return !states_.empty() && states_[present_].choices == choices &&
           same_choices(*states_[present_].settings, settings);
}

void History::note(const Settings& settings, const Choices& choices) {
    if (is_present(settings, choices)) return;
    if (!states_.empty()) states_.resize(present_ + 1);
    states_.push_back({std::make_shared<const Settings>(settings), choices});
    if (states_.size() > most_states) states_.erase(states_.begin());
    present_ = states_.size() - 1;
}

void History::forget(const Property& property) {
    for (State& state : states_) state.choices.erase(property);
}

void History::change_all(const std::function<void(Settings&)>& change) {
    for (State& state : states_) {
        auto changed = std::make_shared<Settings>(*state.settings);
        change(*changed);
        state.settings = std::move(changed);
    }
}

const History::State& History::previous() const {
    if (!can_undo()) throw ArgumentError("nothing to undo");
    return states_[present_ - 1];
}

const History::State& History::next() const {
    if (!can_redo()) throw ArgumentError("nothing to redo");
    return states_[present_ + 1];
}

const History::State& History::undo() {
    const State& state = previous();
    --present_;
    return state;
}

const History::State& History::redo() {
    const State& state = next();
    ++present_;
    return state;
}

}  // namespace easypbr::app
