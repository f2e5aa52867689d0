#include "easypbr/render/drawables/draw_list.h"

#include <cmath>

#include "easypbr/scene/normals.h"
#include "easypbr/scene/settings.h"

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

/// Linear base colour of points without colour or light: as far from the default background as from a dark
/// one.
constexpr float unlit_point = 0.22f;

/// An object and all that decides how it is drawn.
struct Source {
    const SceneSnapshot::Object& object;
    const DrawStyle& style;
    const InferredSettings& settings;
    const Material& textures;
    const ColorMeaning& colors;
    std::shared_ptr<const MeshData> data;  ///< null: the object's
    bool transparent_colors = has_transparent_colors(mesh().C);

    const MeshData& mesh() const { return data ? *data : *object.mesh; }
};

/// With the settings' overrides. Colours of data take the place of the base colour: no setting replaces them.
Material drawn_material(const Source& source, const MeshPart& part) {
    const Material own = material_of(source.mesh(), part);
    if (!source.colors.from_data) return overridden(own, source.settings.material, source.textures);
    // Texture coordinates that are places in a table are none of an image.
    Material textures = source.colors.values ? Material() : source.textures;
    textures.shader = source.textures.shader;
    Material material = overridden(own, source.settings.material, textures);
    material.base_color = Vec3::Ones();
    material.base_color_texture = own.base_color_texture;
    return material;
}

DrawItem make_item(const Source& source, const MeshPart& part) {
    const MeshData& mesh = source.mesh();
    DrawItem item;
    item.object = &source.object;
    item.data = source.data;
    item.colors = source.colors;
    item.part = part;
    item.material = drawn_material(source, part);
    item.style = source.style;
    item.two_sided = source.style.two_sided.value_or(item.material.double_sided);
    const bool own_color = !source.settings.material.color.value();
    item.with_colors =
        !mesh.C.empty() && (source.colors.from_data || (own_color && source.colors.vertex_colors));
    if (!source.colors.textured || (source.colors.from_data && item.with_colors))
        item.material.base_color_texture = {};
    item.material.base_color = item.material.color_factor(item.with_colors, false);
    item.alpha = item.material.alpha_mode_for(item.with_colors && source.transparent_colors);
    return item;
}

/// Lit unless the style says otherwise; then as they are, and those of a table exactly.
SurfaceKind kind_of(const Source& source) {
    if (source.style.lit.value_or(true)) return SurfaceKind::lit;
    return source.colors.exact ? SurfaceKind::exact : SurfaceKind::display;
}

/// What is shown as it is has no radiance, of unlit materials neither.
void set_kind(const Source& source, DrawItem& item) {
    item.kind = kind_of(source);
    if (item.kind != SurfaceKind::lit && !item.material.shader) item.material.unlit = false;
}

void add_mesh(const Source& source, DrawList& list) {
    if (source.mesh().F.empty()) return;
    for (const MeshPart& part : parts_of(source.mesh())) {
        DrawItem item = make_item(source, part);
        // Faces alone show textures.
        item.material.base_color = item.material.color_factor(item.with_colors, !source.mesh().UV.empty());
        set_kind(source, item);
        if (source.style.mode == DrawMode::voxels) item.style.flat = true;
        list.items[DrawMode::mesh].push_back(std::move(item));
    }
}

/// Whether a kind of primitive draws surfaces of an object: lines are none.
bool has_surface(const MeshData& mesh, DrawMode kind) {
    return kind == DrawMode::mesh ? !mesh.F.empty() : kind != DrawMode::lines;
}

/// Of vertices that are drawn as something on their own, or beside a surface of the object, which casts.
void add_vertices(const Source& source, DrawMode kind, bool casts, DrawList& list) {
    const MeshData& mesh = source.mesh();
    if (mesh.V.empty()) return;
    DrawItem item = make_item(source, {});
    set_kind(source, item);
    // As what it is drawn: in place of what the style asks for, where the mesh lacks data for that.
    item.style.mode = kind;
    item.reaches_beyond = true;
    item.casts = casts;
    if (kind == DrawMode::points) {
        // Labels of clouds are there to be read.
        const bool lit = source.style.lit.value_or(!source.colors.labels);
        if (lit && mesh.N.empty())
            item.kind = source.settings.edl.enabled ? SurfaceKind::eye_dome : SurfaceKind::display;
        else if (!lit && source.colors.exact)
            item.kind = SurfaceKind::exact;
        const bool has_colors = item.has_own_colors() || item.material.base_color_texture;
        if (item.kind != SurfaceKind::lit && !has_colors && item.material.has_default_color())
            item.material.base_color = Vec3::Constant(unlit_point);
    }
    list.items[kind].push_back(std::move(item));
}

/// They are unlit, and reach beyond their means.
void add_splats(const Source& source, DrawList& list) {
    if (source.mesh().V.empty()) return;
    DrawItem item = make_item(source, {});
    item.kind = SurfaceKind::display;
    item.reaches_beyond = true;
    list.overlays[DrawMode::splats].push_back(std::move(item));
}

bool has_lines(const MeshData& mesh, const DrawStyle& style) {
    const bool are_shape = style.mode == DrawMode::lines && !(mesh.E.empty() && mesh.F.empty());
    return are_shape || (style.show_wireframe && !mesh.F.empty()) || (style.show_normals && !mesh.V.empty());
}

void add_lines(const Source& source, DrawList& list) {
    if (!has_lines(source.mesh(), source.style)) return;
    DrawItem item = make_item(source, {});
    item.kind = SurfaceKind::display;
    item.reaches_beyond = true;
    list.overlays[DrawMode::lines].push_back(std::move(item));
}

/// All items as surfaces; `set_mask` changes the material of blended ones.
template <class SetMask>
DrawList masked(const DrawList& list, SetMask&& set_mask) {
    DrawList surfaces = list;
    if (auto splats = surfaces.overlays.extract(DrawMode::splats)) surfaces.items.insert(std::move(splats));
    for (auto& [kind, of_kind] : surfaces.items)
        for (DrawItem& item : of_kind) {
            item.layered = false;
            if (item.alpha != AlphaMode::blend) continue;
            item.alpha = AlphaMode::mask;
            set_mask(item.material);
        }
    return surfaces;
}

}  // namespace

std::span<const DrawItem> items_of(const ItemsByKind& items, DrawMode kind) {
    const auto found = items.find(kind);
    return found == items.end() ? std::span<const DrawItem>() : found->second;
}

bool DrawList::empty() const {
    return std::ranges::all_of(items, [](const auto& of_kind) { return of_kind.second.empty(); });
}

DrawList DrawList::without_exact() const {
    return without([](const DrawItem& item) { return item.kind == SurfaceKind::exact && !item.layered; });
}

DrawList DrawList::layers() const {
    return without([](const DrawItem& item) { return !item.layered; });
}

DrawList DrawList::without_layers() const {
    return without([](const DrawItem& item) { return item.layered; });
}

double DrawItem::scale() const {
    return std::cbrt(std::abs(object->T_world_mesh.linear().determinant()));
}

bool DrawItem::needs_tangents() const {
    if (mesh().UV.empty()) return material.anisotropy > 0 && has_all_tangents(mesh());
    return material.normal_texture || material.clearcoat_normal_texture || material.anisotropy > 0;
}

bool DrawItem::has_mapped_normals() const {
    return (material.normal_texture && !mesh().UV.empty()) || material.shader;
}

ExtensionSet DrawList::extensions() const {
    ExtensionSet set = 0;
    for (const DrawItem& item : of(DrawMode::mesh)) set |= item.extensions();
    return set;
}

DrawList DrawList::as_first_hits() const {
    DrawList list = *this;
    const auto meshes = list.items.find(DrawMode::mesh);
    if (meshes == list.items.end()) return list;
    for (DrawItem& item : meshes->second) {
        // A shader of its own is for pixels.
        if (!item.extensions() || item.material.shader) continue;
        item.layered = item.layered && item.alpha == AlphaMode::blend;
        item.kind = SurfaceKind::extended;
    }
    return list;
}

DrawList DrawList::as_surfaces() const {
    return masked(*this, [](Material& blended) { blended.alpha_cutoff = 0.5f; });
}

DrawList DrawList::as_shapes() const {
    return masked(*this, [](Material& blended) {
        blended.opacity = 1;
        blended.alpha_cutoff = 1e-6f;  // 8 bits of alpha are 0 or far more
    });
}

DrawList DrawList::as_casters(bool splats) const {
    DrawList casters = without([](const DrawItem& item) { return !item.casts; });
    auto own = casters.overlays.extract(DrawMode::splats);
    if (!own || !splats) return casters;
    for (DrawItem& item : own.mapped()) item.alpha = AlphaMode::blend;
    casters.items.insert(std::move(own));
    return casters;
}

Vec3 absorption_of(const Material& material) {
    if (!(material.thickness > 0) || !std::isfinite(material.attenuation_distance)) return Vec3::Zero();
    const Vec3 logarithm = material.attenuation_color.cwiseMax(1e-30f).array().log();
    return -logarithm / material.attenuation_distance;
}

DrawList draw_list(const DrawableScene& drawable, const InferredSettings& settings, const Material& textures,
                   const ShaderFiles& shader_files) {
    DrawList list;
    for (size_t i = 0; i < drawable.scene.objects.size(); ++i) {
        const SceneSnapshot::Object& object = drawable.scene.objects[i];
        const DrawStyle style = resolve_style(*object.mesh, settings.style);
        if (!style.visible) continue;
        const Source source{object, style, settings, textures, drawable.meanings[i], {}};
        const DrawMode kind = primitive_of(*object.mesh, style);
        if (kind == DrawMode::mesh) add_mesh(source, list);
        add_lines(source, list);
        if (kind == DrawMode::splats)
            add_splats(source, list);
        else if (kind != DrawMode::mesh && kind != DrawMode::lines)
            add_vertices(source, kind, true, list);
        if (kind == DrawMode::points || !style.show_points) continue;
        const PointsOnTop& points = drawable.points[i];
        const Source on_top{object, style, settings, textures, points.meaning, points.mesh};
        add_vertices(on_top, DrawMode::points, !has_surface(*object.mesh, kind), list);
    }
    for (DrawItem& item : list.items[DrawMode::mesh])
        if (SurfaceShader& shader = item.material.shader; shader.text.empty() && !shader.path.empty())
            shader.text = shader_files.at(shader.path);
    for (auto& [kind, of_kind] : list.items) {
        // Primitives that are one surface where they overlap are drawn in layers in any case: a random number
        // for each would draw them all.
        const bool apart = kind == DrawMode::mesh || kind == DrawMode::points;
        const bool in_layers = !apart || settings.transparency.mode == TransparencyMode::layers;
        for (DrawItem& item : of_kind) {
            item.layered = (item.alpha == AlphaMode::blend && in_layers) ||
                           (apart && item.kind == SurfaceKind::lit && item.material.transmits());
            // What has the alpha of the cutoff is there (glTF 2.0, 3.9.4). Filters of textures round alpha.
            item.material.alpha_cutoff *= 1 - 1e-6f;
        }
    }
    return list;
}

}  // namespace easypbr::render
