#include "easypbr/app/history.h"

#include <algorithm>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/hash.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

bool same_choices(const Settings& a, const Settings& b) {
    return std::ranges::all_of(fields(), [&](const Field& field) {
        const Value x = field.get(a), y = field.get(b);
        return x.state == y.state && (x.state != Value::State::given || x.data == y.data);
    });
}

bool History::is_present(const Settings& settings) const {
    return !states_.empty() && same_choices(*states_[present_].settings, settings);
}

void History::note(const Settings& settings, const ObjectStates& changed, const LightStates& lights) {
    if (changed.empty() && lights.empty() && is_present(settings)) return;
    Step state{std::make_shared<const Settings>(settings), {}, {}};
    if (!states_.empty()) {
        state.objects = states_[present_].objects;
        state.lights = states_[present_].lights;
        states_.resize(present_ + 1);
    }
    for (const auto& [name, object] : changed) {
        ObjectState& known = state.objects[name];
        if (object.T_parent_mesh) known.T_parent_mesh = object.T_parent_mesh;
        if (object.arrays) known.arrays = object.arrays;
        if (!object.materials) continue;
        known.materials = object.materials;
        known.style = object.style;
        known.changes = object.changes;
        known.look = next_revision();
    }
    for (const auto& [name, light] : lights) state.lights[name] = light;
    states_.push_back(std::move(state));
    if (states_.size() > most_states) states_.erase(states_.begin());
    present_ = states_.size() - 1;
}

void History::know(const std::string& object, const ObjectState& before) {
    for (Step& state : states_) {
        ObjectState& known = state.objects[object];
        if (!known.T_parent_mesh) known.T_parent_mesh = before.T_parent_mesh;
        if (!known.materials) known.materials = before.materials;
        if (!known.style) known.style = before.style;
        if (!known.arrays) known.arrays = before.arrays;
    }
}

void History::know_light(const std::string& name, const std::optional<Light>& before) {
    for (Step& state : states_) state.lights.try_emplace(name, before);
}

void History::change_all(const std::function<void(Settings&)>& change) {
    for (Step& state : states_) {
        auto changed = std::make_shared<Settings>(*state.settings);
        change(*changed);
        state.settings = std::move(changed);
    }
}

History::Step History::go(size_t to) {
    Step step = states_[to];
    std::erase_if(step.lights, [&](const auto& light) {
        return states_[present_].lights.at(light.first) == light.second;
    });
    const ObjectStates& now = states_[present_].objects;
    for (auto& [name, object] : step.objects) {
        const auto known = now.find(name);
        if (known == now.end()) continue;
        // What is the same in both is left as the program may have changed it since.
        const auto& pose = known->second.T_parent_mesh;
        if (pose && object.T_parent_mesh && pose->matrix() == object.T_parent_mesh->matrix())
            object.T_parent_mesh.reset();
        if (known->second.arrays == object.arrays) object.arrays.reset();
        object.replaced = known->second.arrays;
        if (known->second.look != object.look) continue;
        object.materials.reset();
        object.style.reset();
    }
    present_ = to;
    return step;
}

History::Step History::undo() {
    if (!can_undo()) throw ArgumentError("nothing to undo");
    return go(present_ - 1);
}

History::Step History::redo() {
    if (!can_redo()) throw ArgumentError("nothing to redo");
    return go(present_ + 1);
}

}  // namespace easypbr::app
