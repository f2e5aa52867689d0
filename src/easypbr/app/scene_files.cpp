#include "easypbr/app/scene_files.h"

#include <fmt/format.h>

#include <set>

#include "easypbr/app/output.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

namespace fs = std::filesystem;

constexpr double watch_seconds = 0.5;

bool is_environment_file(const fs::path& path) {
    const std::string extension = extension_of(path);
    return extension == "hdr" || extension == "exr";
}

std::string unique_name(const Scene& scene, const std::string& stem) {
    std::string name = stem;
    for (int number = 2; scene.contains(name); ++number) name = fmt::format("{}-{}", stem, number);
    return name;
}

void show_loaded(Session& session, AnimationPlayer& player, const io::LoadedScene& loaded,
                 const std::string& name) {
    session.scene().show(loaded.mesh, name);
    if (!loaded.animations.empty()) player.add(name, loaded.animations, session.scene());
    for (const auto& [light, value] : loaded.lights)
        session.scene().set_light(light_name(name, light), value);
}

}  // namespace

io::LoadOptions load_options(const Settings& settings, const std::string& format) {
    return {.crease_angle_deg = settings.load.crease_deg,
            .memory_gb = settings.limits.memory,
            .format = format,
            .variant = settings.load.variant};
}

void SceneFiles::open(const fs::path& path) {
    if (is_environment_file(path)) {
        session_.load_environment(path);
        return notifications_.add("Environment: " + path.filename().string());
    }
    add(io::load_scene(path, load_options(session_.settings())), path);
}

std::string SceneFiles::add(const io::LoadedScene& loaded, const fs::path& path) {
    std::string name = unique_name(session_.scene(), path.stem().string());
    show_loaded(session_, player_, loaded, name);
    notifications_.add("Added " + name);
    return name;
}

void SceneFiles::close(const std::string& name) {
    Scene& scene = session_.scene();
    player_.remove(name);
    if (scene.contains(name)) scene.remove(name);
    for (const std::string& light : scene.light_names())
        if (light.starts_with(name + "/")) scene.remove_light(light);
}

void SceneFiles::watch(const fs::path& path, const std::string& name) {
    watched_.push_back({path, name, fs::last_write_time(path)});
}

void SceneFiles::advance(double seconds) {
    if (watched_.empty() || (since_watch_ += seconds) < watch_seconds) return;
    since_watch_ = 0;
    for (Watched& file : watched_) try {
            std::error_code gone;  // A file that is being replaced may be missing for a moment.
            const auto time = fs::last_write_time(file.path, gone);
            if (gone || time == file.time) continue;
            file.time = time;
            show_loaded(session_, player_, io::load_scene(file.path, load_options(session_.settings())),
                        file.name);
            notifications_.add("Reloaded " + file.name);
        } catch (const Error& error) {
            notifications_.add(error.what(), true);
        }
}

void SceneFiles::save_settings(const fs::path& path) {
    std::set<fs::path> files;
    for (const std::string& name : session_.scene().names())
        if (const fs::path source = session_.scene().get(name).snapshot()->source; !source.empty())
            files.insert(source);
    app::save_settings(session_, {files.begin(), files.end()}, path);
    notifications_.add(fmt::format("Saved {}: easypbr render --settings {} makes this picture", path.string(),
                                   path.filename().string()));
}

}  // namespace easypbr::app
