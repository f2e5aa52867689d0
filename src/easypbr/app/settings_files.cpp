#include "easypbr/app/settings_files.h"

#include <set>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

void ImageFiles::read(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) files_[path];  // The map must not change while threads use it.
    parallel_for(paths.size(), 1, [&](size_t i) {
        File& file = files_.at(paths[i]);
        std::error_code ignored;  // A file that is missing is reported by load_image().
        const auto time = std::filesystem::last_write_time(paths[i], ignored);
        if (!file.image || file.time != time)
            file = {time, std::make_shared<const Image>(io::load_image(paths[i]))};
    });
}

std::shared_ptr<const Image> ImageFiles::get(const std::string& path) const {
    return path.empty() ? nullptr : files_.at(path).image;
}

const std::string& ShaderTexts::get(const std::string& path) {
    File& file = files_[path];
    std::error_code gone;  // A file that is being replaced may be missing for a moment.
    const auto time = std::filesystem::last_write_time(path, gone);
    if (!file.text.empty() && (gone || time == file.time)) return file.text;
    file = {time, std::string(FileBytes(path).text())};
    return file.text;
}

void SettingsFiles::load(const Settings& settings) {
    std::set<std::string> paths;
    for (const MaterialTexture& row : replaceable_textures()) paths.insert(settings.material.*row.setting);
    const bool has_background = settings.background.mode == BackgroundMode::image;
    if (!settings.background.image.empty()) background_.reset();
    if (has_background) {
        if (settings.background.image.empty() && !background_)
            throw ArgumentError("background.mode is image, but background.image names no file");
        paths.insert(settings.background.image);
    }
    paths.erase("");
    image_files_.read({paths.begin(), paths.end()});
    images_ = {};
    for (const MaterialTexture& row : replaceable_textures()) {
        Texture& texture = images_.textures.*row.texture;
        texture.path = settings.material.*row.setting;
        texture.image = image_files_.get(texture.path);
    }
    if (has_background)
        images_.background = background_ ? background_ : image_files_.get(settings.background.image);
    if (settings.environment.file.empty()) {
        environment_ = Environment();
        environment_file_.clear();
    } else if (!is_environment_read(settings.environment.file)) {
        load_environment(settings.environment.file);
    }
}

bool SettingsFiles::is_environment_read(const std::string& file) const {
    if (file != environment_file_) return false;
    std::error_code gone;  // A file that is being replaced may be missing for a moment.
    const auto time = std::filesystem::last_write_time(file, gone);
    return gone || time == environment_time_;
}

void SettingsFiles::load_shaders(const Settings& settings, const SceneSnapshot& scene) {
    if (const std::string& path = settings.material.shader; !path.empty())
        images_.textures.shader = {shader_texts_.get(path), path};
    for (const SceneSnapshot::Object& object : scene.objects)
        for (const Material& material : object.mesh->materials)
            if (const std::string& path = material.shader.path; !path.empty())
                images_.shader_files[path] = shader_texts_.get(path);
}

void SettingsFiles::load_environment(const std::filesystem::path& path) {
    std::error_code ignored;  // A file that is missing is reported by Environment.
    const auto time = std::filesystem::last_write_time(path, ignored);
    environment_ = Environment(path);
    environment_time_ = time;
    environment_file_ = path.string();
}

void SettingsFiles::load_background(const std::filesystem::path& path) {
    image_files_.read({path.string()});
}

void SettingsFiles::set_background(Image image) {
    if (image.empty()) throw ArgumentError("background image: expected pixels, got an empty image");
    background_ = std::make_shared<const Image>(std::move(image));
}

}  // namespace easypbr::app
