#include "easypbr/app/scene_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "easypbr/app/font.h"
#include "easypbr/core/log.h"
#include "easypbr/core/luminance.h"
#include "easypbr/scene/auto_parameters.h"
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
        "Mesh.estimate_surfels() and 'easypbr convert --to-surfels' make them",
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

/// Whether an object is seen without light.
bool shines(const Object& object, const Style& overrides) {
    const auto is_bright = [](const Material& material) {
        return material.unlit || !is_black(material.emissive);
    };
    return !resolve_style(*object.mesh, overrides).lit.value_or(true) ||
           std::ranges::any_of(object.mesh->materials, is_bright);
}

std::string light_text(const SceneSnapshot& scene, const Settings& settings,
                       const ResolvedSettings& resolved) {
    if (!resolved.traces_paths) return {};
    const detail::Content content(scene, settings.style);
    const Box3d& box = content.bounds();
    const auto is_within = [&](const ResolvedLight& light) {
        return light.type != LightType::directional && box.contains(light.position);
    };
    if (box.isEmpty() || !box.contains(resolved.camera.position())) return {};
    const auto is_seen = [&](const Object& object) { return shines(object, settings.style); };
    if (std::ranges::any_of(resolved.lights, is_within) || std::ranges::any_of(scene.objects, is_seen))
        return {};
    if (!detail::enclosure_of(content, resolved.camera)) return {};
    return "lights: content closes around the camera and no light is within, so the picture is dark; add a "
           "light, or set lights.key.position, .intensity, .radius and tonemap.exposure to follow";
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

/// All that is written but for numbers.
std::string texts_of(const Annotation& annotation) {
    std::string texts;
    for (const ColorBar& bar : annotation.bars) texts += bar.title;
    for (const Legend& legend : annotation.legends) {
        texts += legend.title;
        for (const LegendEntry& entry : legend.entries) texts += entry.name;
    }
    return texts;
}

std::string font_text(const Annotation& annotation) {
    constexpr size_t most_named = 8;
    std::vector<std::string> missing = missing_characters(texts_of(annotation));
    if (missing.empty()) return {};
    const size_t others = missing.size() - std::min(missing.size(), most_named);
    missing.resize(missing.size() - others);
    return fmt::format("annotation: the font, DejaVu Sans, lacks {}{}: boxes are drawn instead",
                       fmt::join(missing, ", "), others == 0 ? "" : fmt::format(" and {} more", others));
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

void SceneWarnings::check_light(const SceneSnapshot& scene, const Settings& settings,
                                const ResolvedSettings& resolved) {
    light_.tell(light_text(scene, settings, resolved));
}

void SceneWarnings::check(const Annotation& annotation, const BasicAnnotationSettings<Inferred>& settings,
                          Vec2i size) {
    legend_.tell(legend_text(annotation, settings));
    colorbar_.tell(colorbar_text(annotation, settings));
    font_.tell(font_text(annotation));
    room_.tell(room_text(annotation, settings, size));
}

}  // namespace easypbr::app
