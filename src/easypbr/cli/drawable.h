// Mesh files on their way into a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/scene/camera.h"
#include "easypbr/scene/scene.h"

namespace easypbr::io {
struct LoadedScene;
struct LoadOptions;
}  // namespace easypbr::io

namespace easypbr::cli {

/// What stands for standard input among the files of a command.
inline constexpr const char* standard_input = "-";

/// Adds the option --format, the format of the files.
void declare_format(CLI::App& command, std::string& format);

/// Throws UsageError when standard input stands among the files more than once, or is a terminal.
void check_input(std::string_view command, const std::vector<std::string>& files);

/// Reads a file, or standard input. Throws as io::load_scene() does.
io::LoadedScene load_input(const std::string& file, const io::LoadOptions& options);

/// The same for what has something to draw. Throws FormatError when it has no vertices.
io::LoadedScene load_drawable(const std::string& file, const io::LoadOptions& options);

/// The files' stems, made unique: "a", "b", "a-2"; standard input is "stdin".
std::vector<std::string> unique_names(const std::vector<std::string>& files);

/// Shows the mesh under a name and adds the file's lights as "NAME/LIGHT".
void show(Scene& scene, const io::LoadedScene& loaded, const std::string& name);

struct FileCamera {
    size_t file = 0;  ///< of the files loaded
    std::string name;
    Camera camera;
};

/// The files' camera of this name, or of this number from 0 in the order of files and names. Throws
/// NameError.
FileCamera find_camera(const std::vector<io::LoadedScene>& loaded, const std::string& name_or_number);

}  // namespace easypbr::cli
