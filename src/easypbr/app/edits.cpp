#include "easypbr/app/edits.h"

#include <algorithm>
#include <utility>

#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr::app {

/// The objects with looks, at the last keep_looks().
struct Edits::Shown {
    std::map<std::string, Mesh> objects;
};

namespace {

std::optional<Light> light_named(const Scene& scene, const std::string& name) {
    const auto names = scene.light_names();
    if (std::ranges::find(names, name) == names.end()) return {};
    return scene.light(name);
}

/// Whether a node has the arrays that a person left: a program may have shown others since.
bool is_still(const Mesh& node, const std::shared_ptr<const MeshData>& left) {
    return !left || node.snapshot()->V.revision() == left->V.revision();
}

ObjectState look_of(const Mesh& node) {
    const auto data = node.snapshot();
    ObjectState object;
    object.materials = data->materials;
    object.style = data->style;
    return object;
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

void Edits::change_look(const std::string& object, const std::string& property, const LookChange& change) {
    std::optional<Mesh> node = node_named(session_.scene(), object);
    if (!node) return;
    history_.know(object, look_of(*node));
    node->edit(change);
    changed_looks_.insert(object);
    looks_[object][property] = change;
}

void Edits::change_data(const std::string& object, const LookChange& change) {
    std::optional<Mesh> node = node_named(session_.scene(), object);
    if (!node) return;
    ObjectState before;
    before.arrays = node->snapshot();
    node->edit(change);
    history_.know(object, before);
    changed_data_.insert(object);
}

void Edits::keep_looks() {
    std::map<std::string, Mesh> present;
    for (const auto& [object, changes] : looks_) {
        const std::optional<Mesh> node = node_named(session_.scene(), object);
        if (!node) continue;
        present.insert_or_assign(object, *node);
        const auto known = shown_->objects.find(object);
        if (known == shown_->objects.end() || known->second == *node) continue;
        Mesh shown = *node;
        for (const auto& [property, change] : changes) shown.edit(change);
    }
    shown_->objects = std::move(present);
}

void Edits::will_move(const std::string& object, const Mesh& node) {
    ObjectState before;
    before.T_parent_mesh = node.T_parent_mesh();
    history_.know(object, before);
    changed_poses_.insert(object);
}

void Edits::will_change_light(const std::string& name) {
    history_.know_light(name, light_named(session_.scene(), name));
    changed_lights_.insert(name);
}

void Edits::change_settings(const std::function<void(Settings&)>& change) {
    change(session_.settings());
    history_.change_all(change);
}

bool Edits::has_news() const {
    return !changed_looks_.empty() || !changed_poses_.empty() || !changed_data_.empty() ||
           !changed_lights_.empty() || !history_.is_present(session_.settings());
}

void Edits::note() {
    const Scene& scene = session_.scene();
    ObjectStates changed;
    for (const std::string& name : std::exchange(changed_looks_, {})) {
        const std::optional<Mesh> node = node_named(scene, name);
        if (!node) continue;
        changed[name] = look_of(*node);
        changed[name].changes = looks_[name];
    }
    for (const std::string& name : std::exchange(changed_poses_, {}))
        if (const std::optional<Mesh> node = node_named(scene, name))
            changed[name].T_parent_mesh = node->T_parent_mesh();
    for (const std::string& name : std::exchange(changed_data_, {}))
        if (const std::optional<Mesh> node = node_named(scene, name)) changed[name].arrays = node->snapshot();
    LightStates lights;
    for (const std::string& name : std::exchange(changed_lights_, {}))
        lights[name] = light_named(scene, name);
    history_.note(session_.settings(), changed, lights);
}

void Edits::restore(const History::Step& step) {
    session_.replace_settings(*step.settings);
    for (const auto& [name, object] : step.objects) {
        std::optional<Mesh> node = node_named(session_.scene(), name);
        if (!node) continue;
        if (object.T_parent_mesh) node->set_T_parent_mesh(*object.T_parent_mesh);
        if (object.arrays && is_still(*node, object.replaced))
            node->edit([&arrays = *object.arrays](MeshData& data) { replace_arrays(data, arrays); });
        if (object.materials && object.style)
            node->edit([&look = object](MeshData& data) {
                data.materials = *look.materials;
                data.style = *look.style;
            });
        if (object.materials) looks_[name] = object.changes;
    }
    for (const auto& [name, light] : step.lights) {
        if (light)
            session_.scene().set_light(name, *light);
        else if (light_named(session_.scene(), name))
            session_.scene().remove_light(name);
    }
}

void Edits::undo() {
    note();
    if (history_.can_undo()) restore(history_.undo());
}

void Edits::redo() {
    if (can_redo()) restore(history_.redo());
}

}  // namespace easypbr::app
