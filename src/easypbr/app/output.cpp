#include "easypbr/app/output.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/markup.h"
#include "easypbr/core/suggest.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/settings/presets.h"
#include "easypbr/io/settings/settings_io.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/setting_files.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

Encoding encoding_for(const fs::path& path, bool deep) {
    const std::string extension = extension_of(path);
    const std::vector<std::string> known = io::writable_image_extensions();
    if (std::find(known.begin(), known.end(), extension) == known.end())
        throw ArgumentError(fmt::format("cannot write {}: unknown extension '{}'{}, expected one of {}",
                                        path.string(), extension, did_you_mean(extension, known),
                                        fmt::join(known, ", ")));
    if (deep && extension != "png")
        throw ArgumentError(
            fmt::format("cannot write {}: 16 bits per channel need a PNG file", path.string()));
    if (extension == "hdr" || extension == "exr") return Encoding::scene_linear;
    return deep ? Encoding::srgb16 : Encoding::srgb8;
}

void check_picture_fits(const fs::path& path, Vec2i size) {
    const std::string extension = extension_of(path);
    const int largest = io::largest_image_side(extension);
    if (size.maxCoeff() > largest)
        throw ArgumentError(
            fmt::format("cannot write {}: {}x{} pixels, {} holds at most {} a side; write PNG "
                        "or EXR",
                        path.string(), size.x(), size.y(), extension, largest));
}

void check_holds_alpha(const fs::path& path) {
    const std::string_view lack = io::lack_of_alpha(extension_of(path));
    if (!lack.empty())
        throw ArgumentError(fmt::format(
            "cannot write {}: {}; write a PNG or EXR, or choose another background", path.string(), lack));
}

void check_picture(const fs::path& path, const Settings& settings, std::optional<Vec2i> size) {
    encoding_for(path);
    check_picture_fits(path, size.value_or(settings.image.size));
    if (settings.background.mode == BackgroundMode::transparent) check_holds_alpha(path);
    check_writable(path);
}

fs::path layer_path(const fs::path& picture, const std::string& layer) {
    return picture.parent_path() / fmt::format("{}_{}.exr", picture.stem().string(), layer);
}

fs::path render_to_file(Session& session, const fs::path& path, const PictureOptions& options, bool deep) {
    PictureOptions picture = options;
    picture.encoding = encoding_for(path, deep);
    check_picture(path, session.settings(), options.size);
    io::save_image(session.render(picture), path);
    return path;
}

std::vector<fs::path> layers_to_files(Session& session, const fs::path& path,
                                      const std::vector<std::string>& layers, std::optional<Vec2i> size) {
    for (const std::string& layer : layers) check_writable(layer_path(path, layer));
    std::vector<fs::path> written;
    for (const auto& [layer, image] : session.render_layers(layers, size)) {
        io::save_image(image, layer_path(path, layer));
        written.push_back(layer_path(path, layer));
    }
    return written;
}

namespace {

/// What is drawn and has no file that the settings name.
void warn_of_data(const Session& session, const fs::path& path) {
    const Settings& settings = session.settings();
    const auto warn = [&](const char* what, const char* setting) {
        log_warning(fmt::format("{} does not hold the {}: {} names no file", path.string(), what, setting));
    };
    if (settings.background.mode == BackgroundMode::image && settings.background.image.empty())
        warn("background image", "background.image");
    if (settings.environment.file.empty() && !session.scene().environment().empty())
        warn("environment map", "environment.file");
}

}  // namespace

void save_settings(const Session& session, const std::vector<fs::path>& files, const fs::path& path,
                   std::optional<Vec2i> size) {
    io::SettingsFile file;
    file.settings = session.settings();
    if (size) file.settings.image.size = *size;
    const Scene& scene = session.scene();
    for (const std::string& name : scene.light_names()) file.lights[name] = scene.light(name);
    for (const fs::path& source : files) {
        const std::string name = fs::absolute(source).string();
        if (valid_utf8(name) == name)
            file.files[name] = io::hash_file(source);
        else
            log_warning(
                fmt::format("{} does not hold the hash of {}, whose name is not UTF-8", path.string(), name));
    }
    // Absolute, so that the picture can be made again from any folder.
    for_each_file(file.settings, [&](NamedFile& named) {
        if (named.empty()) return;
        file.files[named.path()] = io::hash_file(named.path_from_here());
        named = named.path();
    });
    io::save_settings(file, path);
    warn_of_data(session, path);
}

namespace {

void take_over(Session& session, const io::SettingsFile& file) {
    session.replace_settings(file.settings);
    for (const auto& [name, light] : file.lights) session.scene().set_light(name, light);
}

}  // namespace

void load_settings(Session& session, const fs::path& path) {
    const io::SettingsFile file = io::load_settings(path);
    std::error_code unreadable;  // Where the file is needed, reading it reports that.
    for (const auto& [source, hash] : file.files)
        if (fs::exists(source, unreadable) && io::hash_file(source) != hash)
            log_warning(fmt::format("{} is not the file that {} was saved with: its content has changed",
                                    source, path.string()));
    take_over(session, file);
}

void apply_settings(Session& session, const fs::path& path) {
    const FileBytes bytes(path);
    io::SettingsFile file{session.settings(), {}, {}};
    io::apply_settings(std::string(bytes.text()), path.string(), file);
    take_over(session, file);
}

void apply_preset(Session& session, const std::string& name_or_path) {
    io::SettingsFile file{session.settings(), {}, {}};
    const CameraSettings camera = file.settings.camera;
    release(file.settings);
    file.settings.camera = camera;
    io::apply_preset(name_or_path, file);
    take_over(session, file);
}

}  // namespace easypbr::app
