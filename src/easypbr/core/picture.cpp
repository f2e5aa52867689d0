#include "easypbr/core/picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"

namespace easypbr {

const std::vector<std::string>& stage_names() {
    static const std::vector<std::string> names = {"light", "overlay", "picture"};
    return names;
}

Stage stage_named(const std::string& name) {
    const auto found = std::ranges::find(stage_names(), name);
    if (found == stage_names().end())
        throw NameError(fmt::format("there is no stage '{}' of passes{}; expected light, overlay or picture",
                                    name, did_you_mean(name, stage_names())));
    return Stage(found - stage_names().begin());
}

const std::vector<std::string>& draw_device_names() {
    static const std::vector<std::string> names = {"auto", "gl", "cpu"};
    return names;
}

DrawDevice draw_device_named(const std::string& name) {
    const auto found = std::ranges::find(draw_device_names(), name);
    if (found == draw_device_names().end())
        throw NameError(fmt::format("there is no device '{}'; expected auto, gl or cpu", name));
    return DrawDevice(found - draw_device_names().begin());
}

}  // namespace easypbr
