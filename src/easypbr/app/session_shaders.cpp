// Of Session: shaders and passes of a program's own.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easypbr/app/pass_adapter.h"
#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/draw_style.h"

namespace easypbr::app {

const std::string& Session::shader_text(const std::string& path) {
    ShaderFile& file = shader_files_[path];
    std::error_code gone;  // A file that is being replaced may be missing for a moment.
    const auto time = std::filesystem::last_write_time(path, gone);
    if (!file.text.empty() && (gone || time == file.time)) return file.text;
    file = {time, std::string(FileBytes(path).text())};
    return file.text;
}

void Session::load_shaders(const SceneSnapshot& scene) {
    if (const std::string& path = settings_.material.shader; !path.empty())
        settings_images_.textures.shader = {shader_text(path), path};
    for (const SceneSnapshot::Object& object : scene.objects)
        for (const Material& material : object.mesh->materials)
            if (const std::string& path = material.shader.path; !path.empty())
                settings_images_.shader_files[path] = shader_text(path);
}

void Session::add_pass(const std::string& name, Stage stage, std::shared_ptr<Pass> pass) {
    if (!pass) throw ArgumentError(fmt::format("pass '{}': expected a pass, got none", name));
    const auto same = [&](const render::CustomPass& custom) { return custom.name == name; };
    const render::CustomPass custom{name, stage, renderer_pass(std::move(pass))};
    if (const auto old = std::ranges::find_if(passes_, same); old != passes_.end())
        *old = custom;
    else
        passes_.push_back(custom);
    if (renderer_) renderer_->set_passes(passes_);
}

void Session::remove_pass(const std::string& name) {
    const auto same = [&](const render::CustomPass& custom) { return custom.name == name; };
    if (std::erase_if(passes_, same) == 0) {
        std::vector<std::string> names;
        for (const render::CustomPass& custom : passes_) names.push_back(custom.name);
        throw NameError(fmt::format("there is no pass '{}'{}", name, did_you_mean(name, names)));
    }
    if (renderer_) renderer_->set_passes(passes_);
}

void Session::warn_of_shaders(const SceneSnapshot& scene) {
    const auto is_without_faces = [&](const SceneSnapshot::Object& object) {
        const auto has_shader = [](const Material& material) { return bool(material.shader); };
        const DrawStyle style = resolve_style(*object.mesh, settings_.style);
        const bool has_faces = style.mode == DrawMode::mesh || style.mode == DrawMode::voxels;
        return style.visible && !has_faces && std::ranges::any_of(object.mesh->materials, has_shader);
    };
    const auto found = std::ranges::find_if(scene.objects, is_without_faces);
    const bool lacking = found != scene.objects.end();
    if (lacking && !warned_of_shaders_)
        log_warning(
            fmt::format("material.shader: '{}' is not drawn as faces, which alone have shaders of their own",
                        found->name));
    warned_of_shaders_ = lacking;
}

}  // namespace easypbr::app
