#include "easypbr/render/draw_list.h"

#include "easypbr/core/color.h"

namespace easypbr::render {
namespace {

/// The parts of a mesh; one part for all faces when it names none.
std::vector<MeshPart> parts_of(const MeshData& mesh) {
    if (!mesh.parts.empty()) return mesh.parts;
    return {MeshPart{{}, 0, int(mesh.F.rows()), 0}};
}

Material material_of(const MeshData& mesh, const MeshPart& part) {
    return size_t(part.material) < mesh.materials.size() ? mesh.materials[size_t(part.material)] : Material{};
}

}  // namespace

Material overridden(const Material& material, const MaterialSettings& settings, const Material& textures) {
    Material m = material;
    // A value from outside stands for the whole: the material's own map would multiply it away.
    if (settings.color.value()) m.base_color = linear_from_srgb(*settings.color), m.base_color_texture = {};
    if (settings.metallic.value()) m.metallic = *settings.metallic, m.metallic_texture = {};
    if (settings.roughness.value()) m.roughness = *settings.roughness, m.roughness_texture = {};
    if (settings.emissive.value()) m.emissive = linear_from_srgb(*settings.emissive), m.emissive_texture = {};
    // A texture from outside stands for the whole value unless a factor is given beside it.
    const auto replace = [](Texture& own, const Texture& given, auto&& neutral_factor) {
        if (!given) return;
        own = given;
        neutral_factor();
    };
    replace(m.base_color_texture, textures.base_color_texture, [&] {
        if (!settings.color.value()) m.base_color = Vec3::Ones();
    });
    replace(m.metallic_texture, textures.metallic_texture, [&] {
        if (!settings.metallic.value()) m.metallic = 1;
    });
    replace(m.roughness_texture, textures.roughness_texture, [&] {
        if (!settings.roughness.value()) m.roughness = 1;
    });
    replace(m.emissive_texture, textures.emissive_texture, [&] {
        if (m.emissive.isZero()) m.emissive = Vec3::Ones();
    });
    replace(m.normal_texture, textures.normal_texture, [] {});
    replace(m.occlusion_texture, textures.occlusion_texture, [] {});
    replace(m.opacity_texture, textures.opacity_texture, [&] {
        if (m.alpha_mode == AlphaMode::opaque) m.alpha_mode = AlphaMode::mask;
    });
    return m;
}

std::vector<DrawItem> draw_list(const SceneSnapshot& scene, const Settings& settings,
                                const Material& textures) {
    std::vector<DrawItem> items;
    for (const auto& object : scene.objects) {
        const MeshData& mesh = *object.mesh;
        if (!settings.style.visible.value_or(mesh.style.visible.value_or(true)) || mesh.F.empty()) continue;
        for (const MeshPart& part : parts_of(mesh)) {
            DrawItem item{&object, part, overridden(material_of(mesh, part), settings.material, textures)};
            item.flat = settings.style.flat.value_or(mesh.style.flat.value_or(false));
            item.two_sided =
                settings.style.two_sided.value_or(mesh.style.two_sided.value_or(item.material.double_sided));
            item.with_colors = !mesh.C.empty() && !settings.material.color.value();
            items.push_back(std::move(item));
        }
    }
    return items;
}

}  // namespace easypbr::render
