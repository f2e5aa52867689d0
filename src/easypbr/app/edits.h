// What a person changes in a session by hand, with undo and redo.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "easypbr/app/history.h"
#include "easypbr/app/session.h"

namespace easypbr::app {

/// The mesh of a node's name, "car" or "car/wheel"; nothing when there is none.
std::optional<Mesh> node_named(const Scene& scene, const std::string& name);

/// Changes of settings are found by note(); those of objects and lights are announced. Undo and redo restore
/// what differs between two states, and leave the rest as the program may have changed it since.
class Edits {
  public:
    /// The session must outlive it.
    explicit Edits(Session& session);
    ~Edits();

    /// Changes a property of a node's look (app/look.h), of all its materials, now and whenever other data
    /// are shown under its name. Throws as set_look().
    void change_look(const std::string& object, const std::string& property, const Value& value);
    /// Where other data are shown under a name than at the last call, looks and poses that a person chose are
    /// theirs too; what they came with is what undo() goes back to. A look, pose or light that differs from
    /// what a person chose was set by the program since, and is its own: undo() and redo() leave it.
    void keep_chosen();

    /// Changes a node's arrays, once: other data under its name are left as they are. Throws what the change
    /// throws.
    void change_data(const std::string& object, const std::function<void(MeshData&)>& change);

    /// What a person has changed, and has not undone.
    std::set<Property> changed() const;

    /// Before an object is moved: undo() puts it back.
    void will_move(const std::string& object);
    /// Before a light of the scene is added, changed or removed.
    void will_change_light(const std::string& name);
    /// Shows a light of a file that is read again, or removes one that the file no longer has. One that a
    /// person has changed or removed stays so; undo() goes back to what the file has.
    void reload_light(const std::string& name, const std::optional<Light>& light);

    /// A change of settings by the program: undo() and redo() leave it. Throws what the change throws.
    void change_settings(const std::function<void(Settings&)>& change);
    /// The same of what differs between `before` and the settings now.
    void leave_to_program(const Settings& before);
    /// Calls a function of the program; the settings that it changes are the program's.
    void as_program(const std::function<void()>& function);

    /// Notes settings and what was changed as one state.
    void note();
    bool can_undo() const { return history_.can_undo() || (!history_.empty() && has_news()); }
    bool can_redo() const { return history_.can_redo(); }
    /// What was not noted yet, as what cannot be drawn, is a state of its own. Nothing happens when there is
    /// nothing to undo.
    void undo();
    void redo();

  private:
    struct Shown;

    /// Keeps what the program has, where a person changes a property for the first time.
    void begin(const Property& property);
    /// The two parts of keep_chosen(): data that replace others, and what the program has set since.
    void give_to_others();
    void leave_changed();
    void restore(const History::State& state);
    /// From one choice to another; none: what the program has.
    void restore(const Property& property, const PropertyValue* from, const PropertyValue* to);
    /// Something was changed since the last note().
    bool has_news() const;

    Session& session_;
    History history_;
    Choices chosen_;                              ///< what note() will note, but for `touched_`
    std::map<Property, PropertyValue> programs_;  ///< what the program has in place of the choices
    std::set<Property> touched_;  ///< poses and lights that were changed since the last note()
    std::unique_ptr<Shown> shown_;
};

}  // namespace easypbr::app
