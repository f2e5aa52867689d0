#include "easypbr/scene/texture_warnings.h"

#include <fmt/format.h>

#include "easypbr/core/image.h"
#include "easypbr/core/log.h"

namespace easypbr {

std::string name_in_warning(const Texture& texture, std::string_view slot) {
    return texture.path.empty() ? std::string(slot) : fmt::format("{} '{}'", slot, texture.path);
}

void warn_of_clamped_colors(const Image& image, std::string_view name) {
    if (image.type() != PixelType::f32) return;
    // What is less than half a code above shows nowhere.
    if (const float largest = largest_color(image); largest > 1 + 0.5f / 255)
        log_warning(
            fmt::format("{}: colours above 1 were clamped to 1, the largest value is {:g}", name, largest));
}

}  // namespace easypbr
