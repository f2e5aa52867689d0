// What the assimp reader answers (assimp/message.h), as values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace easypbr::io {

struct LoadedScene;

/// The scene of a message about a file, which takes at most `memory` bytes beside its images. Throws
/// FormatError when the message is an error, incomplete or damaged, of another version, or holds what no mesh
/// may.
LoadedScene decode_scene(std::span<const std::byte> message, const std::filesystem::path& file,
                         uint64_t memory);

/// The extensions of a message; `name` stands in messages. Throws FormatError.
std::vector<std::string> decode_extensions(std::span<const std::byte> message, const std::string& name);

}  // namespace easypbr::io
