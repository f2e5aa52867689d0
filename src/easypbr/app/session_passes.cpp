// Of Session: passes of a program's own.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/app/pass_adapter.h"
#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"

namespace easypbr::app {

void Session::add_pass(const std::string& name, Stage stage, std::shared_ptr<Pass> pass) {
    if (!pass) throw ArgumentError(fmt::format("pass '{}': expected a pass, got none", name));
    const render::CustomPass custom{name, stage, renderer_pass(std::move(pass))};
    const auto same = [&](const render::CustomPass& other) { return other.name == name; };
    if (const auto old = std::ranges::find_if(passes_, same); old != passes_.end())
        *old = custom;
    else
        passes_.push_back(custom);
    if (device_->renderer) device_->renderer->set_passes(passes_);
}

void Session::remove_pass(const std::string& name) {
    const auto same = [&](const render::CustomPass& custom) { return custom.name == name; };
    if (std::erase_if(passes_, same) == 0) {
        std::vector<std::string> names;
        for (const render::CustomPass& custom : passes_) names.push_back(custom.name);
        throw NameError(fmt::format("there is no pass '{}'{}", name, did_you_mean(name, names)));
    }
    if (device_->renderer) device_->renderer->set_passes(passes_);
}

}  // namespace easypbr::app
