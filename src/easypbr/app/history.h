// Undo and redo of settings, the camera among them, and of what a person did to objects and lights.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/scene/light.h"
#include "easypbr/scene/mesh_data.h"
#include "easypbr/scene/style.h"

namespace easypbr {
struct Settings;
}

namespace easypbr::app {

/// Whether a person would see a difference: what is inferred does not count.
bool same_choices(const Settings& a, const Settings& b);

/// A change to an object's look, by the property that it sets; made again when other data are shown under the
/// same name.
using LookChange = std::function<void(MeshData&)>;

/// What a person changed of an object; what was never changed is not known, and stays the program's.
struct ObjectState {
    std::optional<Eigen::Affine3d> T_parent_mesh;
    std::optional<std::vector<Material>> materials;
    std::optional<Style> style;
    std::map<std::string, LookChange> changes;
    uint64_t look = 0;  ///< tells looks of one object apart
    /// Its arrays, where a person has removed some of them.
    std::shared_ptr<const MeshData> arrays;
    std::shared_ptr<const MeshData> replaced;  ///< of a step: the arrays that these stand in for
};
/// By the object's name.
using ObjectStates = std::map<std::string, ObjectState>;
/// Lights of the scene by name; none: there is no such light.
using LightStates = std::map<std::string, std::optional<Light>>;

/// States of settings, objects and lights, oldest first. What is noted after undo() drops what was undone.
class History {
  public:
    /// Whether they are the present state's, but for what is inferred.
    bool is_present(const Settings& settings) const;
    /// Notes the settings, unless they are the present ones but for what is inferred, and the objects and
    /// lights that were changed since the last note.
    void note(const Settings& settings, const ObjectStates& changed = {}, const LightStates& lights = {});
    /// What an object was before a person changed it for the first time: it was so in all states.
    void know(const std::string& object, const ObjectState& before);
    void know_light(const std::string& name, const std::optional<Light>& before);
    /// What the program changes is so in all states.
    void change_all(const std::function<void(Settings&)>& change);

    bool empty() const { return states_.empty(); }
    bool can_undo() const { return present_ > 0; }
    bool can_redo() const { return present_ + 1 < states_.size(); }

    /// What has to be restored.
    struct Step {
        std::shared_ptr<const Settings> settings;
        ObjectStates objects;  ///< what is another way than now
        LightStates lights;    ///< the same
    };
    /// To the state before or after the present one, which it then is. Throws ArgumentError when there is
    /// none.
    Step undo();
    Step redo();

    static constexpr size_t most_states = 200;

  private:
    Step go(size_t to);

    std::vector<Step> states_;  ///< with all objects and lights that are known
    size_t present_ = 0;
};

}  // namespace easypbr::app
