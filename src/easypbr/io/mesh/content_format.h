// The format of a mesh file by its content, for bytes that come without a file's name.
#pragma once

#include <string>
#include <string_view>

namespace easypbr::io {

/// The extension of the format that the bytes are in: "ply", "glb", "gltf", "npy", "npz", "las", "pcd",
/// "off", "spz", "stl", "obj", "pts" or "xyz" (any text of columns); empty when it cannot be told, as of the
/// formats that only assimp reads, of SPLAT and of KITTI's scans.
std::string format_of_content(std::string_view bytes);

}  // namespace easypbr::io
