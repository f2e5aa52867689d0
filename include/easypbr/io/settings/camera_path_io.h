// Camera paths as JSON files.
#pragma once

#include <filesystem>
#include <string>

#include "easypbr/scene/camera_path.h"

namespace easypbr::io {

/// Reads {"easypbr_camera_path": 1, "mode": "smooth" | "linear", "ease": "none" | "in" | "out" | "in_out",
/// "closed": false, "axes": "opengl" | "opencv", "segment_s": 1, "keys": [...]}; all but the keys may be
/// missing. A key is a 4 x 4 matrix T_world_cam (rows, or 16 numbers row by row) or an object with
/// "T_world_cam", or "position" and "target" and perhaps "up", and perhaps "segment_s" and "fov_y_deg". A
/// list of keys alone is a path too. In place of keys: "orbit": {"T_world_cam", "center", "axis",
/// "angle_deg", "duration_s"}. Throws FileError; FormatError with the place for what is no camera path.
CameraPath load_camera_path(const std::filesystem::path& path);
/// The same from text; `name` stands in messages.
CameraPath parse_camera_path(const std::string& json, const std::string& name);

/// Numbers come back to the bit. Throws FileError; never leaves half a file.
void save_camera_path(const CameraPath& camera_path, const std::filesystem::path& path);
std::string to_json(const CameraPath& camera_path);

}  // namespace easypbr::io
