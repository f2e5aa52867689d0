#include "easypbr/cli/drawable.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <set>

#include "easypbr/app/animation_player.h"
#include "easypbr/cli/command.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/mesh/file_scene.h"
#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::cli {

void declare_format(CLI::App& command, std::string& format) {
    command
        .add_option("--format", format, "Format of the mesh files, as an extension: ply, obj, glb and so on")
        ->option_text("NAME");
}

void check_input(std::string_view command, const std::vector<std::string>& files) {
    const auto count = std::ranges::count(files, standard_input);
    if (count > 1) throw UsageError(fmt::format("{}: standard input can be read once only", command));
    if (count == 1 && ::isatty(STDIN_FILENO))
        throw UsageError(
            fmt::format("{}: standard input is a terminal; redirect it or name a file", command));
}

io::LoadedScene load_input(const std::string& file, const io::LoadOptions& options) {
    if (file != standard_input) return io::load_scene(file, options);
    const char* const name = "standard input";
    try {
        return io::load_scene(FileBytes(STDIN_FILENO, name), name, options);
    } catch (const FormatError& error) {
        if (!options.format.empty()) throw;
        throw FormatError(fmt::format("{} (--format names the format)", error.what()));
    }
}

io::LoadedScene load_drawable(const std::string& file, const io::LoadOptions& options) {
    io::LoadedScene loaded = load_input(file, options);
    Eigen::Index vertices = 0;
    for_each_node(loaded.mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        vertices += data->V.rows();
    });
    if (vertices == 0) throw FormatError(fmt::format("{} has no vertices: there is nothing to draw", file));
    return loaded;
}

std::vector<std::string> unique_names(const std::vector<std::string>& files) {
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const std::string& file : files) {
        const std::string stem = file == standard_input ? "stdin" : fs::path(file).stem().string();
        std::string name = stem;
        for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}-{}", stem, number);
        names.push_back(name);
    }
    return names;
}

FileCamera find_camera(const std::vector<io::LoadedScene>& loaded, const std::string& name_or_number) {
    std::vector<std::string> names;
    for (size_t file = 0; file < loaded.size(); ++file)
        for (const auto& [name, camera] : loaded[file].cameras) {
            if (name == name_or_number || std::to_string(names.size()) == name_or_number)
                return {file, name, camera};
            names.push_back(name);
        }
    if (names.empty()) throw NameError("--camera: there is no camera in the files");
    throw NameError(fmt::format("--camera: there is no camera '{}'{}: the files have {}", name_or_number,
                                did_you_mean(name_or_number, names), fmt::join(names, ", ")));
}

void show(Scene& scene, const io::LoadedScene& loaded, const std::string& name) {
    scene.show(loaded.mesh, name);
    for (const auto& [light_name, light] : loaded.lights)
        scene.set_light(app::light_name(name, light_name), light);
}

}  // namespace easypbr::cli
