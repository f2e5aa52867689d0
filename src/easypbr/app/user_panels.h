// Panels of a program's own: their names and the functions that draw them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "easypbr/app/widgets.h"

namespace easypbr::app {

using PanelFunction = std::function<void(Widgets&)>;

/// Functions may add and remove panels, their own too.
class UserPanels {
  public:
    /// A panel of the same name is replaced. Throws ArgumentError for a name without letters.
    void add(const std::string& name, PanelFunction function);
    /// Throws NameError when there is none.
    void remove(const std::string& name);
    bool empty() const { return panels_.empty(); }
    /// In the order in which they were added.
    std::vector<std::string> names() const;
    /// Grows with every add() of the name, so that a panel that was closed is shown again; 0: there is none.
    uint64_t revision(const std::string& name) const;

    /// Has a panel draw itself. Returns what its function threw, as text; empty: nothing. Nothing happens
    /// when there is none of this name.
    std::string call(const std::string& name, Widgets& widgets);
    /// What each function threw in its last call; empty: nothing.
    std::map<std::string, std::string> errors() const;

  private:
    struct Panel {
        std::string name;
        PanelFunction function;
        uint64_t revision = 0;
        std::string error;  ///< of the last call
    };
    Panel* find(const std::string& name);

    std::vector<Panel> panels_;
    uint64_t added_ = 0;
};

}  // namespace easypbr::app
