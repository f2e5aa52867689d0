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

/// Changes of settings are found by note(); those of objects and lights are announced.
class Edits {
  public:
    /// The session must outlive it.
    explicit Edits(Session& session);
    ~Edits();

    /// Changes a node's look now and whenever other data are shown under its name (keep_looks()). `property`
    /// names what is changed: a later change of the same one takes its place. Throws what the change throws.
    void change_look(const std::string& object, const std::string& property, const LookChange& change);
    /// Makes the changes again where other data are shown under a name than at the last call.
    void keep_looks();

    /// Changes a node's arrays, once: other data under its name are left as they are. Throws what the change
    /// throws.
    void change_data(const std::string& object, const LookChange& change);

    /// Before an object is moved: undo() puts it back.
    void will_move(const std::string& object, const Mesh& node);
    /// Before a light of the scene is added, changed or removed.
    void will_change_light(const std::string& name);

    /// A change of settings by the program: undo() and redo() leave it. Throws what the change throws.
    void change_settings(const std::function<void(Settings&)>& change);

    /// Notes settings and what was changed as one state.
    void note();
    bool can_undo() const { return history_.can_undo() || (!history_.empty() && has_news()); }
    bool can_redo() const { return history_.can_redo(); }
    /// What was not noted yet, as what cannot be drawn, is a state of its own. Nothing happens when there is
    /// nothing to undo.
    void undo();
    void redo();

  private:
    void restore(const History::Step& step);
    /// Something was changed since the last note().
    bool has_news() const;

    Session& session_;
    History history_;
    std::map<std::string, std::map<std::string, LookChange>> looks_;  ///< by object, by property
    struct Shown;
    std::unique_ptr<Shown> shown_;
    /// Objects and lights that were changed since the last note().
    std::set<std::string> changed_looks_, changed_poses_, changed_data_, changed_lights_;
};

}  // namespace easypbr::app
