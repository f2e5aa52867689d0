// The long tail of mesh formats, through assimp, which is run in a process of its own: what makes it crash or
// loop is an error like any other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "easypbr/io/source/child_process.h"

namespace easypbr::io {

struct LoadedScene;

/// What reading one file may take.
struct AssimpLimits {
    double seconds = 60;                    ///< since the start of the reader, and of CPU time
    uint64_t bytes = uint64_t(2048) << 20;  ///< of memory: of the reader, of its answer, and of the scene
};

/// The limits for a file of that size.
AssimpLimits assimp_limits(uint64_t file_bytes);

/// Reads any format that assimp knows; files that it names are found as from its folder. Throws FileError;
/// FormatError when assimp refuses the file, crashes, or meets a limit, or when the reader (the program
/// easypbr_read_assimp beside libeasypbr.so) is not there; Interrupted. Thread-safe.
LoadedScene load_assimp(const std::filesystem::path& path);
LoadedScene load_assimp(const std::filesystem::path& path, const AssimpLimits& limits);

/// The reader's answer to a file, sealed (assimp/message.h). FormatError in a FolderScope, which does not
/// bind the reader. Throws as load_assimp() does, but for what the answer says.
SharedMemory ask_assimp(const std::filesystem::path& path, const AssimpLimits& limits);

/// Extensions that assimp reads, sorted; empty without its reader. Throws Interrupted.
std::vector<std::string> assimp_extensions();

}  // namespace easypbr::io
