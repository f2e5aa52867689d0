#include "easypbr/app/scene_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "easypbr/app/output.h"
#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/opened_files.h"
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

/// The object and the nodes below it that are hidden themselves.
void add_hidden(const Mesh& node, const std::string& path, std::set<std::string>& hidden) {
    const auto data = node.snapshot();
    if (!data->style.visible.value_or(true)) hidden.insert(path);
    for (const Mesh& child : data->children) add_hidden(child, path + "/" + child.name(), hidden);
}

/// A light that is not there, of the file of an object that is.
bool is_missing_light(const Scene& scene, const std::string& light) {
    const auto lights = scene.light_names(), objects = scene.names();
    return std::ranges::find(lights, light) == lights.end() &&
           std::ranges::any_of(objects,
                               [&](const std::string& object) { return light.starts_with(object + "/"); });
}

/// As short as a person writes it: relative to the working folder where the file lies in it, unless the name
/// would pass for an option.
fs::path short_path(const fs::path& file) {
    std::error_code failed;
    const fs::path relative = file.lexically_relative(fs::current_path(failed));
    const bool is_outside = failed || relative.empty() || *relative.begin() == "..";
    return is_outside || relative.string().starts_with('-') ? file : relative;
}

/// A word of a POSIX shell's command line.
std::string shell_word(const std::string& text) {
    const auto is_plain = [](char c) {
        return ascii::is_alnum(c) || std::string_view("_@%+=:,./-").find(c) != std::string_view::npos;
    };
    if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
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

void SceneFiles::watch(const fs::path& path, const std::string& name, const io::LoadedScene& loaded,
                       const std::string& format) {
    Watched file{path, name, format, {}, {}};
    follow(file, loaded);
    watched_.push_back(std::move(file));
}

void SceneFiles::follow(Watched& watched, const io::LoadedScene& loaded) {
    watched.lights = loaded.lights;
    watched.is_animated = !loaded.animations.empty();
    watched.times = loaded.files;
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

void SceneFiles::change_lights(const Watched& from, const io::LoadedScene& to) {
    const std::vector<std::string> shown = session_.scene().light_names();
    for (const auto& [light, value] : to.lights) {
        const std::string name = light_name(from.name, light);
        const auto before = from.lights.find(light);
        const bool is_same = before != from.lights.end() && before->second == value;
        // An animation may have left it elsewhere.
        const bool is_moved = from.is_animated && std::ranges::find(shown, name) != shown.end();
        if (!is_same || is_moved) edits_.reload_light(name, value);
    }
    for (const auto& [light, value] : from.lights)
        if (!to.lights.contains(light)) edits_.reload_light(light_name(from.name, light), std::nullopt);
}

io::LoadedScene SceneFiles::read_again(Watched& file) {
    OpenedFiles opened;
    const OpenedFilesScope noted(&opened);
    try {
        return io::load_scene(file.path, load_options(session_.settings(), file.format));
    } catch (const Error&) {
        // What it lacks may be written later.
        for (const auto& [path, time] : opened.times()) file.times.insert_or_assign(path, time);
        throw;
    }
}

void SceneFiles::reload(Watched& file) {
    const io::LoadedScene loaded = read_again(file);
    show(loaded, file.name);
    if (file.is_animated && loaded.animations.empty()) player_.remove(file.name);
    change_lights(file, loaded);
    edits_.keep_chosen();
    follow(file, loaded);
    notifications_.add("Reloaded " + file.name);
}

std::vector<fs::path> SceneFiles::sources() const {
    std::vector<fs::path> files;
    for (const std::string& name : session_.scene().names()) {
        const fs::path source = session_.scene().get(name).snapshot()->source;
        if (!source.empty() && std::ranges::find(files, source) == files.end()) files.push_back(source);
    }
    return files;
}

std::vector<std::string> SceneFiles::unsaved() const {
    const Scene& scene = session_.scene();
    std::map<std::string, std::set<std::string>> names;
    for (const std::string& name : scene.names()) {
        add_hidden(scene.get(name), name, names["objects hidden"]);
        if (scene.get(name).snapshot()->source.empty()) names["objects without a file"].insert(name);
    }
    for (const Property& property : edits_.changed()) {
        using Kind = Property::Kind;
        if (property.kind == Kind::light && is_missing_light(scene, property.of))
            names["lights removed"].insert(property.of);
        if (property.kind == Kind::light || !node_named(scene, property.of)) continue;
        if (property.kind == Kind::arrays) names["vertices removed"].insert(property.of);
        if (property.kind == Kind::pose) names["poses changed"].insert(property.of);
        if (property.kind == Kind::look && property.look != "style.visible")
            names["materials and styles changed"].insert(property.of);
    }
    std::vector<std::string> texts;
    for (const auto& [what, of] : names)
        if (!of.empty()) texts.push_back(fmt::format("{} ({})", what, fmt::join(of, ", ")));
    if (player_.shown_time() > 0) texts.push_back("the time of the animation");
    return texts;
}

void SceneFiles::save_settings(const fs::path& path, Vec2i size) {
    const std::vector<fs::path> files = sources();
    app::save_settings(session_, files, path, size);
    if (files.empty())
        return notifications_.add(
            fmt::format("Saved {}; nothing that is shown was read from a file", path.string()));
    std::string command = "easypbr render";
    for (const fs::path& file : files) command += " " + shell_word(short_path(file).string());
    command += fmt::format(" --settings {} -o {}", shell_word(path.string()),
                           shell_word(fs::path(path).replace_extension(".png").string()));
    const std::vector<std::string> without = unsaved();
    notifications_.add(fmt::format("Saved {}: {} makes this picture{}{}", path.string(), command,
                                   without.empty() ? "" : ", but for ", fmt::join(without, ", ")));
}

}  // namespace easypbr::app
