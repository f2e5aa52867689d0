// Warnings of textures that are drawn or written.
#pragma once

#include <string>
#include <string_view>

#include "easypbr/scene/material.h"

namespace easypbr {

/// A texture in a warning: its slot, as "roughness_texture", and the file that it came from.
std::string name_in_warning(const Texture& texture, std::string_view slot);

/// Warns where 8 bits clamp colours of an image to 1; only f32 has values above. `name`: of its texture.
void warn_of_clamped_colors(const Image& image, std::string_view name);

}  // namespace easypbr
