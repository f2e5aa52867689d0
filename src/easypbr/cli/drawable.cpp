#include "easypbr/cli/drawable.h"

#include <fmt/format.h>

#include <set>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"

namespace easypbr::cli {

io::LoadedScene load_drawable(const std::filesystem::path& path, const io::LoadOptions& options) {
    io::LoadedScene loaded = io::load_scene(path, options);
    Eigen::Index vertices = 0;
    for_each_node(loaded.mesh, [&](const std::shared_ptr<const MeshData>& data, const Eigen::Affine3d&) {
        vertices += data->V.rows();
    });
    if (vertices == 0)
        throw FormatError(fmt::format("{} has no vertices: there is nothing to draw", path.string()));
    return loaded;
}

std::vector<std::string> unique_names(const std::vector<std::string>& files) {
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const std::string& file : files) {
        const std::string stem = std::filesystem::path(file).stem().string();
        std::string name = stem;
        for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}-{}", stem, number);
        names.push_back(name);
    }
    return names;
}

Camera find_camera(const std::vector<io::LoadedScene>& loaded, const std::string& name_or_number) {
    std::vector<std::string> names;
    for (const io::LoadedScene& file : loaded)
        for (const auto& [name, camera] : file.cameras) {
            if (name == name_or_number || std::to_string(names.size()) == name_or_number) return camera;
            names.push_back(name);
        }
    if (names.empty()) throw NameError("--camera: there is no camera in the files");
    throw NameError(fmt::format("--camera: there is no camera '{}'{}: the files have {}", name_or_number,
                                did_you_mean(name_or_number, names), fmt::join(names, ", ")));
}

void show(Scene& scene, const io::LoadedScene& loaded, const std::string& name) {
    scene.show(loaded.mesh, name);
    for (const auto& [light_name, light] : loaded.lights) scene.set_light(name + "/" + light_name, light);
}

}  // namespace easypbr::cli
