#include "easypbr/gui/state.h"

#include <algorithm>
#include <utility>

#include "easypbr/core/error.h"

namespace easypbr::gui {
namespace {

std::optional<Light> light_named(const Scene& scene, const std::string& name) {
    const auto names = scene.light_names();
    if (std::ranges::find(names, name) == names.end()) return {};
    return scene.light(name);
}

void restore(GuiState& state, const app::History::Step& step) {
    state.session.replace_settings(step.settings);
    for (const auto& [name, object] : step.objects) {
        std::optional<Mesh> node = node_named(state.session.scene(), name);
        if (!node) continue;
        if (object.T_parent_mesh) node->set_T_parent_mesh(*object.T_parent_mesh);
        if (object.materials && object.style)
            node->edit([&look = object](MeshData& data) {
                data.materials = *look.materials;
                data.style = *look.style;
            });
        if (object.materials) state.looks[name] = object.changes;
    }
    for (const auto& [name, light] : step.lights) {
        if (light)
            state.session.scene().set_light(name, *light);
        else if (light_named(state.session.scene(), name))
            state.session.scene().remove_light(name);
    }
}

app::ObjectState look_of(const Mesh& node) {
    const auto data = node.snapshot();
    app::ObjectState object;
    object.materials = data->materials;
    object.style = data->style;
    return object;
}

}  // namespace

const char* panel_name(Panel panel) {
    constexpr const char* names[panel_count] = {"Scene",       "Object",      "Effects",  "Lights",
                                                "Environment", "Camera",      "Channels", "Statistics",
                                                "Animations",  "Camera path", "Recorder"};
    return names[size_t(panel)];
}

std::optional<Mesh> node_named(const Scene& scene, const std::string& name) {
    for (const std::string& root : scene.names()) {
        if (name != root && !name.starts_with(root + "/")) continue;
        Mesh node = scene.get(root);
        std::string path = root;
        for (bool found = true; found && path != name;) {
            found = false;
            for (const Mesh& child : node.snapshot()->children) {
                const std::string child_path = path + "/" + child.name();
                if (name != child_path && !name.starts_with(child_path + "/")) continue;
                const Mesh next = child;
                node = next;
                path = child_path;
                found = true;
                break;
            }
        }
        if (path == name) return node;
    }
    return {};
}

void change_look(GuiState& state, const std::string& object, const std::string& property,
                 const LookChange& change) {
    std::optional<Mesh> node = node_named(state.session.scene(), object);
    if (!node) return;
    try {
        state.history.know(object, look_of(*node));
        node->edit(change);
        state.changed_looks.insert(object);
        state.looks[object][property] = change;
    } catch (const Error& error) {
        state.notify(error.what(), true);
    }
}

void will_move(GuiState& state, const std::string& object, const Mesh& node) {
    app::ObjectState before;
    before.T_parent_mesh = node.T_parent_mesh();
    state.history.know(object, before);
    state.changed_poses.insert(object);
}

void will_change_light(GuiState& state, const std::string& name) {
    state.history.know_light(name, light_named(state.session.scene(), name));
    state.changed_lights.insert(name);
}

void note_history(GuiState& state) {
    app::ObjectStates changed;
    for (const std::string& name : std::exchange(state.changed_looks, {})) {
        const std::optional<Mesh> node = node_named(state.session.scene(), name);
        if (!node) continue;
        changed[name] = look_of(*node);
        changed[name].changes = state.looks[name];
    }
    for (const std::string& name : std::exchange(state.changed_poses, {}))
        if (const std::optional<Mesh> node = node_named(state.session.scene(), name))
            changed[name].T_parent_mesh = node->T_parent_mesh();
    app::LightStates lights;
    for (const std::string& name : std::exchange(state.changed_lights, {}))
        lights[name] = light_named(state.session.scene(), name);
    state.history.note(state.settings(), changed, lights);
}

void undo(GuiState& state) {
    if (state.history.can_undo()) restore(state, state.history.undo());
}

void redo(GuiState& state) {
    if (state.history.can_redo()) restore(state, state.history.redo());
}

}  // namespace easypbr::gui
