// Undo and redo of settings, the camera among them.
#pragma once

#include <vector>

#include "easypbr/scene/settings.h"

namespace easypbr::app {

/// Whether a person would see a difference: what is inferred does not count.
bool same_choices(const Settings& a, const Settings& b);

/// States of the settings, oldest first. What is noted after undo() drops what was undone.
class History {
  public:
    /// Notes a state, unless it is the present one but for what is inferred.
    void note(const Settings& settings);

    bool can_undo() const { return present_ > 0; }
    bool can_redo() const { return present_ + 1 < states_.size(); }
    /// The state before or after the present one, which it then is. Throws ArgumentError when there is none.
    const Settings& undo();
    const Settings& redo();

    static constexpr size_t most_states = 200;

  private:
    std::vector<Settings> states_;
    size_t present_ = 0;
};

}  // namespace easypbr::app
