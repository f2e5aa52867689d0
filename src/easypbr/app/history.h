// Undo and redo of settings, the camera among them, and of what a person did to objects and lights.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "easypbr/scene/fields.h"
#include "easypbr/scene/light.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {
struct Settings;
}

namespace easypbr::app {

/// Whether a person would see no difference: what is inferred does not count.
bool same_choice(const Value& a, const Value& b);

/// The fields that a person would see a difference of, with the values of `now`: what is inferred does not
/// count.
std::vector<std::pair<std::string, Value>> changed_choices(const Settings& before, const Settings& now);

/// Whether there are none.
bool same_choices(const Settings& a, const Settings& b);

/// What a person can change by hand beside the settings.
struct Property {
    enum class Kind { arrays, pose, look, light };
    std::string of;  ///< the name of the object, or of the light
    Kind kind = Kind::look;
    std::string look = {};  ///< see app/look.h

    bool operator<(const Property& other) const {
        return std::tie(of, kind, look) < std::tie(other.of, other.kind, other.look);
    }
    bool operator==(const Property&) const = default;
};

/// What a property is: the arrays of an object, its pose, a value for all of it or one for each material, a
/// light, or none where it is removed.
using PropertyValue = std::variant<std::shared_ptr<const MeshData>, Eigen::Affine3d, Value,
                                   std::vector<Value>, std::optional<Light>>;
/// What a person has chosen, each choice an object of its own; the rest is the program's.
using Choices = std::map<Property, std::shared_ptr<const PropertyValue>>;

/// States of settings and choices, oldest first. What is noted after undo() drops what was undone.
class History {
  public:
    struct State {
        std::shared_ptr<const Settings> settings;
        Choices choices;
    };

    /// Whether they are the present state's, but for what is inferred.
    bool is_present(const Settings& settings, const Choices& choices = {}) const;
    /// Notes a state, unless it is the present one but for what is inferred.
    void note(const Settings& settings, const Choices& choices = {});
    /// The property is the program's in all states.
    void forget(const Property& property);
    /// What the program changes is so in all states.
    void change_all(const std::function<void(Settings&)>& change);

    bool empty() const { return states_.empty(); }
    bool can_undo() const { return present_ > 0; }
    bool can_redo() const { return present_ + 1 < states_.size(); }

    /// The state before or after the present one. Throws ArgumentError when there is none.
    const State& previous() const;
    const State& next() const;
    /// Makes it the present one. Throws the same.
    const State& undo();
    const State& redo();

    static constexpr size_t most_states = 200;

  private:
    std::vector<State> states_;
    size_t present_ = 0;
};

}  // namespace easypbr::app
