// Mesh files on their way into a scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/scene.h"

namespace easypbr::cli {

/// Reads a file that has something to draw. Throws as io::load_scene() does; FormatError when it has no
/// vertices.
io::LoadedScene load_drawable(const std::filesystem::path& path, const io::LoadOptions& options);

/// The files' stems, made unique: "a", "b", "a-2".
std::vector<std::string> unique_names(const std::vector<std::string>& files);

/// Shows the mesh under a name and adds the file's lights as "NAME/LIGHT".
void show(Scene& scene, const io::LoadedScene& loaded, const std::string& name);

/// The files' camera of this name, or of this number from 0 in the order of files and names. Throws
/// NameError.
Camera find_camera(const std::vector<io::LoadedScene>& loaded, const std::string& name_or_number);

}  // namespace easypbr::cli
