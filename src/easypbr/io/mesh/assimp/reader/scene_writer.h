// Scenes as assimp reads them.
#pragma once

#include <string>
#include <vector>

#include "easypbr/io/mesh/assimp/reader/message_writer.h"

namespace easypbr::io {

/// Reads a file and writes what is in it. Throws std::runtime_error when it cannot be read; the message is
/// incomplete then.
void write_scene(const std::string& path, MessageWriter& out);

/// The extensions that assimp reads, sorted.
void write_extensions(MessageWriter& out);

}  // namespace easypbr::io
