// What a frame draws: items with their final material and style, by kind of primitive.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "easypbr/core/luminance.h"
#include "easypbr/render/drawables/drawable_scene.h"
#include "easypbr/render/frame/extensions.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/draw_style.h"

namespace easypbr {
struct MaterialSettings;
}

namespace easypbr::render {

struct DrawItem {
    const SceneSnapshot::Object* object = nullptr;
    std::shared_ptr<const MeshData> data;  ///< what is drawn; null: the object's
    MeshPart part;                         ///< of a mesh; others are drawn whole
    Material material;                     ///< with the settings' overrides
    AlphaMode alpha = AlphaMode::opaque;   ///< what the material's alpha_mode stands for here
    DrawStyle style;
    bool two_sided = true;
    bool with_colors = false;  ///< vertex colours count
    ColorMeaning colors;       ///< how they are meant
    SurfaceKind kind = SurfaceKind::lit;
    bool layered = false;         ///< other surfaces are seen behind: drawn in layers over the picture
    bool reaches_beyond = false;  ///< its primitives reach beyond the vertices
    bool casts = true;  ///< shadows, and rays meet it; no: a surface of the same object does in its stead

    const MeshData& mesh() const { return data ? *data : *object->mesh; }
    /// The factor of its pose on lengths: the cube root of that on volumes.
    double scale() const;
    bool emits() const { return material.unlit || !is_black(material.emissive) || material.shader; }
    /// Colours by the data of vertices or faces. Points may have those of a texture besides; lines have none.
    bool has_own_colors() const { return with_colors || colors.values; }
    bool textured() const { return material.has_textures() && !mesh().UV.empty(); }
    /// Its shadow is a tint: it weakens light instead of stopping it.
    bool casts_tint() const {
        return alpha == AlphaMode::blend || (kind == SurfaceKind::lit && material.transmits());
    }
    /// Lights fall on it. A shader of its own may light what the material does not.
    bool receives_shadows() const { return kind == SurfaceKind::lit && (!material.unlit || material.shader); }
    /// Light goes through a solid.
    bool is_volume() const { return material.transmits() && material.thickness > 0; }
    /// What is seen through it is blurred.
    bool blurs_behind() const {
        return material.transmits() && (material.roughness > 0 || material.roughness_texture);
    }
    bool needs_tangents() const;
    /// Normals lean from the surface: by a map, or as a shader of its own may do.
    bool has_mapped_normals() const;
    /// What its shading needs beyond glTF's core model.
    ExtensionSet extensions() const { return kind == SurfaceKind::lit ? extensions_of(material) : 0; }
};

/// Drawn over everything else.
inline bool is_over(const DrawItem& item) {
    return item.style.overlay;
}

/// By kind of primitive, each in the order in which they are drawn.
using ItemsByKind = std::map<DrawMode, std::vector<DrawItem>>;

std::span<const DrawItem> items_of(const ItemsByKind& items, DrawMode kind);

struct DrawList {
    ItemsByKind items;  ///< surfaces; of meshes one item per part
    /// Unlit, drawn into the overlay between the layers, without shadows; no list in it is empty.
    ItemsByKind overlays;

    std::span<const DrawItem> of(DrawMode kind) const { return items_of(items, kind); }
    /// Whether a predicate holds for any of the surfaces.
    template <class Predicate>
    bool has(Predicate&& predicate) const {
        return std::ranges::any_of(items, [&](const auto& of_kind) {
            return std::ranges::any_of(of_kind.second, std::ref(predicate));
        });
    }
    /// Whether something is shown past light and tone curve.
    bool needs_overlay() const {
        return !overlays.empty() || has([](const DrawItem& item) { return is_display(item.kind); });
    }
    bool reaches_beyond_vertices() const { return !overlays.empty() || has(&DrawItem::reaches_beyond); }
    /// The list without the surfaces for which a predicate holds.
    template <class Predicate>
    DrawList without(Predicate&& predicate) const {
        DrawList rest = *this;
        for (auto& [kind, of_kind] : rest.items) std::erase_if(of_kind, std::ref(predicate));
        return rest;
    }
    /// Of surfaces; there may be overlays.
    bool empty() const;
    /// The items whose colours may be averaged: others are mixed with them in any case where they are
    /// layers.
    DrawList without_exact() const;
    /// The items that light passes, which are drawn in layers, and the others.
    DrawList layers() const;
    DrawList without_layers() const;
    /// Of all items together.
    ExtensionSet extensions() const;
    /// The items where paths begin at them: what their extensions are, and what light passes them, is up to
    /// the paths.
    DrawList as_first_hits() const;
    /// All items as surfaces that hide what is behind them: what depth, ids and labels are of. A blended
    /// surface is one where its opacity is at least one half, and so are splats together.
    DrawList as_surfaces() const;
    /// The same with all of a blended surface, whatever its opacity, but for what the alpha of its texture or
    /// its vertices cuts out altogether: what amodal masks are of.
    DrawList as_shapes() const;
    /// What casts shadows and is met by rays: all surfaces that cast, and, with `splats`, those too, which
    /// weaken light by their opacity.
    DrawList as_casters(bool splats) const;
    /// Whether some of these surfaces are none in pictures.
    bool has_soft_surfaces() const { return overlays.contains(DrawMode::splats); }
};

/// What the files of the materials' shaders hold, by path.
using ShaderFiles = std::map<std::string, std::string>;

/// All items in the order of the scene. `textures` are the settings' own, which stand in for the materials',
/// its shader too.
DrawList draw_list(const DrawableScene& drawable, const InferredSettings& settings, const Material& textures,
                   const ShaderFiles& shader_files = {});

/// -ln(transmittance) of a material's volume, per world unit; 0 where nothing is absorbed.
Vec3 absorption_of(const Material& material);

/// A material with the settings' overrides applied.
Material overridden(const Material& material, const MaterialSettings& settings, const Material& textures);

}  // namespace easypbr::render
