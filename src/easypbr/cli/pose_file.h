// Camera poses as text files.
#pragma once

#include <filesystem>
#include <vector>

namespace easypbr::cli {

/// opengl: x right, y up, z backwards. opencv: x right, y down, z forwards.
enum class PoseAxes { opengl, opencv };

/// The 4x4 matrix T_world_cam of a text file, row by row, with OpenGL's axes. The file holds 16 numbers
/// separated by blanks, commas or line ends, in the given axes. Throws FileError, FormatError.
std::vector<double> load_pose(const std::filesystem::path& path, PoseAxes axes);

}  // namespace easypbr::cli
