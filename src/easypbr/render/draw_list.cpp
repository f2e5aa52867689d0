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

/// An object and all that decides how it is drawn.
struct Source {
    const SceneSnapshot::Object& object;
    const DrawStyle& style;
    const Settings& settings;
    const Material& textures;
};

DrawItem make_item(const Source& source, const MeshPart& part) {
    const MeshData& mesh = *source.object.mesh;
    DrawItem item;
    item.object = &source.object;
    item.part = part;
    item.material = overridden(material_of(mesh, part), source.settings.material, source.textures);
    item.style = source.style;
    item.two_sided = source.style.two_sided.value_or(item.material.double_sided);
    item.with_colors = !mesh.C.empty() && !source.settings.material.color.value();
    return item;
}

void add_mesh(const Source& source, DrawList& list) {
    if (source.object.mesh->F.empty()) return;
    for (const MeshPart& part : parts_of(*source.object.mesh)) {
        list.meshes.push_back(make_item(source, part));
        if (!source.style.lit.value_or(true)) list.meshes.back().kind = SurfaceKind::display;
    }
}

void add_points(const Source& source, DrawList& list) {
    const MeshData& mesh = *source.object.mesh;
    if (mesh.V.empty()) return;
    DrawItem item = make_item(source, {});
    if (!source.style.lit.value_or(!mesh.N.empty()))
        item.kind = SurfaceKind::display;
    else if (mesh.N.empty())
        item.kind = source.settings.eye_dome.enabled ? SurfaceKind::eye_dome : SurfaceKind::display;
    list.points.push_back(std::move(item));
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

DrawList DrawList::without_exact() const {
    DrawList rest = *this;
    for (std::vector<DrawItem>* items : {&rest.meshes, &rest.points})
        std::erase_if(*items, [](const DrawItem& item) { return item.kind == SurfaceKind::exact; });
    return rest;
}

DrawList draw_list(const SceneSnapshot& scene, const Settings& settings, const Material& textures) {
    DrawList list;
    for (const auto& object : scene.objects) {
        const DrawStyle style = resolve_style(*object.mesh, settings.style);
        if (!style.visible) continue;
        const Source source{object, style, settings, textures};
        if (style.mode == DrawMode::mesh) add_mesh(source, list);
        if (style.mode == DrawMode::points || style.show_points) add_points(source, list);
    }
    return list;
}

}  // namespace easypbr::render
