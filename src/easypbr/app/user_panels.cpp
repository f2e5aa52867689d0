#include "easypbr/app/user_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"

namespace easypbr::app {
namespace {

std::string thrown_by(const PanelFunction& function, Widgets& widgets) {
    try {
        function(widgets);
        return {};
    } catch (const std::exception& error) {
        return error.what();
    } catch (...) {
        return "an exception that is no std::exception";
    }
}

}  // namespace

void UserPanels::add(const std::string& name, PanelFunction function) {
    if (name.empty()) throw ArgumentError("a panel needs a name");
    if (!function) throw ArgumentError(fmt::format("panel '{}': expected a function", name));
    Panel added{name, std::move(function), ++added_, {}};
    if (Panel* known = find(name))
        *known = std::move(added);
    else
        panels_.push_back(std::move(added));
}

void UserPanels::remove(const std::string& name) {
    if (!find(name)) throw NameError(fmt::format("no panel '{}'{}", name, did_you_mean(name, names())));
    std::erase_if(panels_, [&](const Panel& panel) { return panel.name == name; });
}

std::vector<std::string> UserPanels::names() const {
    std::vector<std::string> names;
    for (const Panel& panel : panels_) names.push_back(panel.name);
    return names;
}

uint64_t UserPanels::revision(const std::string& name) const {
    const auto found = std::ranges::find(panels_, name, &Panel::name);
    return found == panels_.end() ? 0 : found->revision;
}

std::string UserPanels::call(const std::string& name, Widgets& widgets) {
    const Panel* panel = find(name);
    if (!panel) return {};
    const PanelFunction function = panel->function;  // A copy: it may be replaced while it runs.
    const std::string error = thrown_by(function, widgets);
    if (Panel* called = find(name)) called->error = error;
    return error;
}

std::map<std::string, std::string> UserPanels::errors() const {
    std::map<std::string, std::string> errors;
    for (const Panel& panel : panels_) errors[panel.name] = panel.error;
    return errors;
}

UserPanels::Panel* UserPanels::find(const std::string& name) {
    const auto found = std::ranges::find(panels_, name, &Panel::name);
    return found == panels_.end() ? nullptr : &*found;
}

}  // namespace easypbr::app
