// Materials of a message of the assimp reader.
#pragma once

#include <filesystem>
#include <vector>

#include "easypbr/io/mesh/assimp/message_cursor.h"
#include "easypbr/scene/material.h"

namespace easypbr::io {

/// Takes images and materials off a message, and reads the textures that they name beside the file, or within
/// it; what cannot be read is a warning. Throws Error.
std::vector<Material> take_materials(MessageCursor& message, const std::filesystem::path& file);

}  // namespace easypbr::io
