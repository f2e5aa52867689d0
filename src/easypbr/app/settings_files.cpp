#include "easypbr/app/settings_files.h"

#include <map>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

void ImageFiles::read(const std::vector<NamedFile>& files) {
    for (const NamedFile& file : files) files_[file.path()];  // The map must not change while threads use it.
    parallel_for(files.size(), 1, [&](size_t i) {
        File& file = files_.at(files[i].path());
        std::error_code ignored;  // A file that is missing is reported by load_().
        const auto time = std::filesystem::last_write_time(files[i].path(), ignored);
        if (!file.image || file.time != time)
            file = {time, std::make_shared<const Image>(load_(files[i].path_from_here()))};
    });
}

std::shared_ptr<const Image> ImageFiles::get(const NamedFile& file) const {
    return file.empty() ? nullptr : files_.at(file.path()).image;
}

const std::string& ShaderTexts::get(const NamedFile& named) {
    File& file = files_[named.path()];
    std::error_code gone;  // A file that is being replaced may be missing for a moment.
    const auto time = std::filesystem::last_write_time(named.path(), gone);
    if (!file.text.empty() && (gone || time == file.time)) return file.text;
    file = {time, std::string(FileBytes(named.path_from_here()).text())};
    return file.text;
}

void SettingsFiles::load(const Settings& settings) {
    std::map<std::string, NamedFile> files;  // Two that are read at once are not the same.
    const auto add = [&](const NamedFile& file) {
        if (!file.empty()) files.emplace(file.path(), file);
    };
    for (const MaterialTexture& row : replaceable_textures()) add(settings.material.*row.setting);
    const bool has_background = settings.background.mode == BackgroundMode::image;
    if (!settings.background.image.empty()) background_.reset();
    if (has_background) {
        if (settings.background.image.empty() && !background_)
            throw ArgumentError("background.mode is image, but background.image names no file");
        if (!settings.background.image.empty()) background_files_.read({settings.background.image});
    }
    std::vector<NamedFile> wanted;
    for (const auto& [path, file] : files) wanted.push_back(file);
    image_files_.read(wanted);
    images_ = {};
    for (const MaterialTexture& row : replaceable_textures()) {
        Texture& texture = images_.textures.*row.texture;
        const NamedFile& file = settings.material.*row.setting;
        texture.path = file.path_from_here();
        texture.image = image_files_.get(file);
    }
    if (has_background)
        images_.background = background_ ? background_ : background_files_.get(settings.background.image);
    if (settings.environment.file.empty()) {
        environment_ = Environment();
        environment_path_.clear();
    } else if (!is_environment_read(settings.environment.file)) {
        read_environment(settings.environment.file);
    }
}

bool SettingsFiles::is_environment_read(const NamedFile& file) const {
    if (file.path() != environment_path_) return false;
    std::error_code gone;  // A file that is being replaced may be missing for a moment.
    const auto time = std::filesystem::last_write_time(file.path(), gone);
    return gone || time == environment_time_;
}

void SettingsFiles::load_shaders(const Settings& settings, const SceneSnapshot& scene) {
    if (const NamedFile& file = settings.material.shader; !file.empty())
        images_.textures.shader = {shader_texts_.get(file), file.path_from_here()};
    for (const SceneSnapshot::Object& object : scene.objects)
        for (const Material& material : object.mesh->materials)
            if (const std::string& path = material.shader.path; !path.empty())
                images_.shader_files[path] = shader_texts_.get(path);
}

void SettingsFiles::load_environment(const std::filesystem::path& path) {
    read_environment(path.string());
}

void SettingsFiles::read_environment(const NamedFile& file) {
    std::error_code ignored;  // A file that is missing is reported by Environment.
    const auto time = std::filesystem::last_write_time(file.path(), ignored);
    environment_ = Environment(std::filesystem::path(file.path_from_here()));
    environment_time_ = time;
    environment_path_ = file.path();
}

void SettingsFiles::load_background(const std::filesystem::path& path) {
    background_files_.read({path.string()});
}

void SettingsFiles::set_background(Image image) {
    if (image.empty()) throw ArgumentError("background image: expected pixels, got an empty image");
    background_ = std::make_shared<const Image>(std::move(image));
}

}  // namespace easypbr::app
