// A fragmented MP4 made an ordinary one.
#pragma once

#include <filesystem>

namespace easypbr::io {

/// Copies the packets of an MP4 or MOV into one whose index comes first, beside it, and puts that in its
/// place. Throws FileError, and leaves the file as it was.
void index_first(const std::filesystem::path& path);

}  // namespace easypbr::io
