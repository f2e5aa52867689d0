#include "easypbr/app/scene_warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/log.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

using Object = SceneSnapshot::Object;

/// The first object that `lacks` something, by name; empty: none does.
template <class Lacks>
std::string first_name(const SceneSnapshot& scene, const Lacks& lacks) {
    const auto found = std::ranges::find_if(scene.objects, lacks);
    return found == scene.objects.end() ? std::string() : found->name;
}

std::string lens_text(const Settings& settings, const ResolvedSettings& resolved) {
    if (!settings.depth_of_field.enabled || resolved.camera.projection != Projection::orthographic) return {};
    return "depth_of_field.enabled: an orthographic camera has no lens, so nothing is blurred";
}

std::string surfels_text(const SceneSnapshot& scene, const Settings& settings) {
    const std::string name = first_name(scene, [&](const Object& object) {
        const DrawStyle style = resolve_style(*object.mesh, settings.style);
        return style.visible && style.mode == DrawMode::surfels && object.mesh->N.empty();
    });
    if (name.empty()) return {};
    return fmt::format(
        "style.mode: '{}' has no normals to draw surfels from and is shown as points; "
        "Mesh.estimate_surfels() and "
        "'easypbr convert --to-surfels' make them",
        name);
}

std::string shaders_text(const SceneSnapshot& scene, const Settings& settings) {
    const std::string name = first_name(scene, [&](const Object& object) {
        const auto has_shader = [](const Material& material) { return bool(material.shader); };
        const DrawStyle style = resolve_style(*object.mesh, settings.style);
        const bool has_faces = style.mode == DrawMode::mesh || style.mode == DrawMode::voxels;
        return style.visible && !has_faces && std::ranges::any_of(object.mesh->materials, has_shader);
    });
    if (name.empty()) return {};
    return fmt::format("material.shader: '{}' is not drawn as faces, which alone have shaders of their own",
                       name);
}

std::string legend_text(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings) {
    if (!settings.legend || !annotation.legends.empty()) return {};
    return "annotation.legend: nothing is coloured by labels, there is no legend";
}

std::string colorbar_text(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings) {
    if (!settings.colorbar || !annotation.bars.empty()) return {};
    return "annotation.colorbar: nothing is coloured by values, there is no colour bar";
}

std::string room_text(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                      Vec2i size) {
    const int left_out = annotations_left_out(annotation, settings, size);
    if (left_out == 0) return {};
    return fmt::format(
        "annotation: an image of {}x{} pixels has no room for {} of {} legends and colour bars", size.x(),
        size.y(), left_out, annotation.legends.size() + annotation.bars.size());
}

}  // namespace

void SceneWarnings::Once::tell(const std::string& text) {
    if (!text.empty() && !told) log_warning(text);
    told = !text.empty();
}

void SceneWarnings::check(const SceneSnapshot& scene, const Settings& settings,
                          const ResolvedSettings& resolved) {
    lens_.tell(lens_text(settings, resolved));
    normals_.tell(surfels_text(scene, settings));
    shaders_.tell(shaders_text(scene, settings));
}

void SceneWarnings::check(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                          Vec2i size) {
    legend_.tell(legend_text(annotation, settings));
    colorbar_.tell(colorbar_text(annotation, settings));
    room_.tell(room_text(annotation, settings, size));
}

}  // namespace easypbr::app
