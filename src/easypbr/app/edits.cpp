#include "easypbr/app/edits.h"

#include <algorithm>
#include <utility>

#include "easypbr/app/look.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

/// The objects with properties that a person has changed, at the last keep_chosen().
struct Edits::Shown {
    std::map<std::string, Mesh> objects;
};

namespace {

using Arrays = std::shared_ptr<const MeshData>;
using PropertyKind = Property::Kind;

std::optional<Light> light_named(const Scene& scene, const std::string& name) {
    const auto names = scene.light_names();
    if (std::ranges::find(names, name) == names.end()) return {};
    return scene.light(name);
}

PropertyValue value_now(const Mesh& node, const Property& property) {
    if (property.kind == PropertyKind::arrays) return node.snapshot();
    if (property.kind == PropertyKind::pose) return node.T_parent_mesh();
    return look_values(*node.snapshot(), property.look);
}

/// Nothing where there is no such object.
std::optional<PropertyValue> value_now(const Scene& scene, const Property& property) {
    if (property.kind == PropertyKind::light) return light_named(scene, property.of);
    const std::optional<Mesh> node = node_named(scene, property.of);
    return node ? std::optional(value_now(*node, property)) : std::nullopt;
}

/// Gives a property of an object, or a light, its value.
struct Put {
    Scene& scene;
    const Property& property;

    void operator()(const Arrays& arrays) const {
        edit([&](MeshData& data) { replace_arrays(data, *arrays); });
    }
    void operator()(const Eigen::Affine3d& pose) const {
        if (std::optional<Mesh> node = node_named(scene, property.of)) node->set_T_parent_mesh(pose);
    }
    void operator()(const Value& value) const {
        edit([&](MeshData& data) { set_look(data, property.look, value); });
    }
    void operator()(const std::vector<Value>& values) const {
        edit([&](MeshData& data) { set_look(data, property.look, values); });
    }
    void operator()(const std::optional<Light>& light) const {
        if (light)
            scene.set_light(property.of, *light);
        else if (light_named(scene, property.of))
            scene.remove_light(property.of);
    }

  private:
    void edit(const std::function<void(MeshData&)>& change) const {
        if (std::optional<Mesh> node = node_named(scene, property.of)) node->edit(change);
    }
};

bool same_vertices(const PropertyValue& a, const PropertyValue& b) {
    return std::get<Arrays>(a)->V.revision() == std::get<Arrays>(b)->V.revision();
}

/// Whether a property is as a person has chosen it; but for arrays.
struct IsChosen {
    const PropertyValue& now;

    bool operator()(const Arrays&) const { return true; }
    bool operator()(const Eigen::Affine3d& pose) const {
        return std::get<Eigen::Affine3d>(now).matrix() == pose.matrix();
    }
    bool operator()(const Value& value) const {
        return std::ranges::all_of(std::get<std::vector<Value>>(now),
                                   [&](const Value& own) { return same_choice(own, value); });
    }
    bool operator()(const std::vector<Value>& values) const {
        return std::ranges::equal(std::get<std::vector<Value>>(now), values, same_choice);
    }
    bool operator()(const std::optional<Light>& light) const {
        return without_inferred(std::get<std::optional<Light>>(now)) == without_inferred(light);
    }

  private:
    static std::optional<Light> without_inferred(std::optional<Light> light) {
        if (light) light->radius.release();
        return light;
    }
};

const PropertyValue* choice_in(const Choices& choices, const Property& property) {
    const auto found = choices.find(property);
    return found == choices.end() ? nullptr : found->second.get();
}

}  // namespace

std::optional<Mesh> node_named(const Scene& scene, const std::string& name) {
    for (const std::string& root : scene.names()) {
        if (name != root && !name.starts_with(root + "/")) continue;
        Mesh node = scene.get(root);
        std::string path = root;
        for (bool found = true; found && path != name;) {
            found = false;
            const auto data = node.snapshot();  // keeps the children
            for (const Mesh& child : data->children) {
                const std::string child_path = path + "/" + child.name();
                if (name != child_path && !name.starts_with(child_path + "/")) continue;
                node = child;
                path = child_path;
                found = true;
                break;
            }
        }
        if (path == name) return node;
    }
    return {};
}

Edits::Edits(Session& session) : session_(session), shown_(std::make_unique<Shown>()) {}
Edits::~Edits() = default;

void Edits::begin(const Property& property) {
    keep_chosen();
    if (chosen_.contains(property) || touched_.contains(property)) return;
    std::optional<PropertyValue> now = value_now(session_.scene(), property);
    if (!now) return;
    programs_.insert_or_assign(property, std::move(*now));
    if (property.kind == PropertyKind::light) return;
    if (const std::optional<Mesh> node = node_named(session_.scene(), property.of))
        shown_->objects.try_emplace(property.of, *node);
}

void Edits::change_look(const std::string& object, const std::string& property, const Value& value) {
    const std::optional<Mesh> node = node_named(session_.scene(), object);
    if (!node) return;
    const Property changed{object, PropertyKind::look, property};
    begin(changed);
    Put{session_.scene(), changed}(value);
    // As it is read again: numbers are rounded to float.
    const std::vector<Value> now = look_values(*node->snapshot(), property);
    chosen_[changed] = std::make_shared<const PropertyValue>(now.front());
}

void Edits::change_data(const std::string& object, const std::function<void(MeshData&)>& change) {
    std::optional<Mesh> node = node_named(session_.scene(), object);
    if (!node) return;
    const Property changed{object, PropertyKind::arrays};
    const PropertyValue* left = choice_in(chosen_, changed);
    // The program has shown others since: there is no way back from them to what was before.
    if (left && !same_vertices(*left, node->snapshot())) {
        history_.forget(changed);
        chosen_.erase(changed);
    }
    begin(changed);
    node->edit(change);
    chosen_[changed] = std::make_shared<const PropertyValue>(node->snapshot());
}

std::set<Property> Edits::changed() const {
    std::set<Property> changed = touched_;
    for (const auto& [property, value] : chosen_) changed.insert(property);
    return changed;
}

void Edits::keep_chosen() {
    give_to_others();
    leave_changed();
}

void Edits::leave_changed() {
    std::erase_if(chosen_, [&](const auto& choice) {
        const auto& [property, value] = choice;
        if (touched_.contains(property)) return false;
        const std::optional<PropertyValue> now = value_now(session_.scene(), property);
        if (!now || std::visit(IsChosen{*now}, *value)) return false;
        history_.forget(property);
        return true;
    });
}

void Edits::give_to_others() {
    std::map<std::string, Mesh> present;
    for (auto& [property, programs] : programs_) {
        if (property.kind == PropertyKind::light) continue;
        const std::optional<Mesh> node = node_named(session_.scene(), property.of);
        if (!node) continue;
        present.insert_or_assign(property.of, *node);
        const auto known = shown_->objects.find(property.of);
        if (known == shown_->objects.end() || known->second == *node) continue;
        if (property.kind == PropertyKind::arrays) continue;
        programs = value_now(*node, property);
        if (const PropertyValue* chosen = choice_in(chosen_, property))
            std::visit(Put{session_.scene(), property}, *chosen);
    }
    shown_->objects = std::move(present);
}

void Edits::will_move(const std::string& object) {
    const Property moved{object, PropertyKind::pose};
    begin(moved);
    touched_.insert(moved);
}

void Edits::will_change_light(const std::string& name) {
    const Property changed{name, PropertyKind::light};
    begin(changed);
    touched_.insert(changed);
}

void Edits::reload_light(const std::string& name, const std::optional<Light>& light) {
    const Property property{name, PropertyKind::light};
    if (const auto known = programs_.find(property); known != programs_.end()) known->second = light;
    if (!chosen_.contains(property) && !touched_.contains(property)) Put{session_.scene(), property}(light);
}

void Edits::change_settings(const std::function<void(Settings&)>& change) {
    change(session_.settings());
    history_.change_all(change);
}

void Edits::leave_to_program(const Settings& before) {
    const auto changed = changed_choices(before, session_.settings());
    if (changed.empty()) return;
    history_.change_all([&](Settings& settings) {
        for (const auto& [name, value] : changed) field(name).put(settings, value);
    });
}

void Edits::as_program(const std::function<void()>& function) {
    const Settings before = session_.settings();
    try {
        function();
    } catch (...) {
        leave_to_program(before);
        throw;
    }
    leave_to_program(before);
}

bool Edits::has_news() const {
    return !touched_.empty() || !history_.is_present(session_.settings(), chosen_);
}

void Edits::note() {
    for (const Property& property : std::exchange(touched_, {}))
        if (std::optional<PropertyValue> now = value_now(session_.scene(), property))
            chosen_[property] = std::make_shared<const PropertyValue>(std::move(*now));
    history_.note(session_.settings(), chosen_);
}

void Edits::restore(const Property& property, const PropertyValue* from, const PropertyValue* to) {
    const auto programs = programs_.find(property);
    if (programs == programs_.end()) return;
    if (property.kind == PropertyKind::arrays) {
        // The program may have shown others since, which stay.
        const std::optional<PropertyValue> now = value_now(session_.scene(), property);
        if (!now || !same_vertices(*now, from ? *from : programs->second)) return;
    } else if (!from) {
        begin(property);
    }
    std::visit(Put{session_.scene(), property}, to ? *to : programs->second);
}

void Edits::restore(const History::State& state) {
    Choices all = chosen_;
    all.insert(state.choices.begin(), state.choices.end());
    for (const auto& [property, choice] : all) {
        const PropertyValue *from = choice_in(chosen_, property), *to = choice_in(state.choices, property);
        if (from != to) restore(property, from, to);
    }
    session_.replace_settings(*state.settings);
    chosen_ = state.choices;
}

void Edits::undo() {
    keep_chosen();
    note();
    if (!history_.can_undo()) return;
    restore(history_.previous());
    history_.undo();
}

void Edits::redo() {
    keep_chosen();
    if (!can_redo()) return;
    restore(history_.next());
    history_.redo();
}

}  // namespace easypbr::app
