#include "easypbr/app/scene_files.h"

#include <fmt/format.h>

#include <fstream>
#include <set>
#include <utility>

#include "easypbr/app/output.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/material_table.h"
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

/// Images that a mesh and what hangs from it were textured with.
void add_textures(const Mesh& mesh, std::set<fs::path>& files) {
    const auto data = mesh.snapshot();
    for (const Material& material : data->materials)
        for (const MaterialTexture& use : material_textures())
            if (const std::string& path = (material.*use.texture).path; !path.empty()) files.insert(path);
    for (const Mesh& child : data->children) add_textures(child, files);
}

/// Files beside `path` that hold a part of it, and that it names: materials of OBJ, buffers of glTF.
void add_parts(const fs::path& path, std::set<fs::path>& files) {
    const std::string kind = extension_of(path);
    const std::string part = kind == "obj" ? "mtl" : kind == "gltf" ? "bin" : "";
    if (part.empty()) return;
    constexpr size_t looked_at = 16 << 20;
    std::string text(looked_at, '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(size_t(in.gcount()));
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(path.parent_path() / ".", ignored))
        if (extension_of(entry.path()) == part && text.find(entry.path().filename().string()) != text.npos)
            files.insert(entry.path());
}

}  // namespace

io::LoadOptions load_options(const Settings& settings, const std::string& format) {
    const Auto<float>& crease = settings.load.crease_deg;
    return {.crease_angle_deg = crease.is_pinned() ? crease.value() : std::nullopt,
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
    show(loaded, name);
    for (const auto& [light, value] : loaded.lights)
        session_.scene().set_light(light_name(name, light), value);
    notifications_.add("Added " + name);
    return name;
}

void SceneFiles::show(const io::LoadedScene& loaded, const std::string& name) {
    session_.scene().show(loaded.mesh, name);
    if (!loaded.animations.empty()) player_.add(name, loaded.animations, session_.scene());
}

void SceneFiles::close(const std::string& name) {
    Scene& scene = session_.scene();
    player_.remove(name);
    if (scene.contains(name)) scene.remove(name);
    for (const std::string& light : scene.light_names())
        if (light.starts_with(name + "/")) scene.remove_light(light);
}

void SceneFiles::watch(const fs::path& path, const std::string& name) {
    Watched file{path, name, {}};
    note_files(file);
    watched_.push_back(std::move(file));
}

void SceneFiles::note_files(Watched& watched) const {
    std::set<fs::path> files = {watched.path};
    if (session_.scene().contains(watched.name)) add_textures(session_.scene().get(watched.name), files);
    add_parts(watched.path, files);
    std::error_code gone;
    for (const fs::path& file : files) {
        const auto time = fs::last_write_time(file, gone);
        watched.times.try_emplace(file, gone ? fs::file_time_type::min() : time);
    }
}

void SceneFiles::advance(double seconds) {
    if (watched_.empty() || (since_watch_ += seconds) < watch_seconds) return;
    since_watch_ = 0;
    for (Watched& file : watched_) try {
            bool changed = false;
            for (auto& [path, known] : file.times) {
                std::error_code gone;  // A file that is being replaced may be missing for a moment.
                const auto time = fs::last_write_time(path, gone);
                changed |= !gone && std::exchange(known, time) != time;
            }
            if (changed && session_.scene().contains(file.name)) reload(file);
        } catch (const Error& error) {
            notifications_.add(error.what(), true);
        }
}

void SceneFiles::reload(Watched& file) {
    const io::LoadedScene loaded = io::load_scene(file.path, load_options(session_.settings()));
    show(loaded, file.name);
    for (const auto& [light, value] : loaded.lights) edits_.reload_light(light_name(file.name, light), value);
    edits_.keep_chosen();
    note_files(file);
    notifications_.add("Reloaded " + file.name);
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
