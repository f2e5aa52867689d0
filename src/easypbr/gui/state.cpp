#include "easypbr/gui/state.h"

#include "easypbr/core/error.h"

namespace easypbr::gui {
namespace {

void restore(GuiState& state, const Settings& settings) {
    // What is shown how large is not a matter of the settings' history.
    state.session.replace_settings(settings);
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
        node->edit(change);
        state.looks[object][property] = change;
    } catch (const Error& error) {
        state.notify(error.what(), true);
    }
}

void undo(GuiState& state) {
    if (state.history.can_undo()) restore(state, state.history.undo());
}

void redo(GuiState& state) {
    if (state.history.can_redo()) restore(state, state.history.redo());
}

}  // namespace easypbr::gui
