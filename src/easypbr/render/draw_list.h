// What a frame draws: items with their final material and style, one list per kind of primitive.
#pragma once

#include <algorithm>
#include <vector>

#include "easypbr/render/surface_kind.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {

struct DrawItem {
    const SceneSnapshot::Object* object = nullptr;
    MeshPart part;                        ///< of a mesh; others are drawn whole
    Material material;                    ///< with the settings' overrides
    AlphaMode alpha = AlphaMode::opaque;  ///< what the material's alpha_mode stands for here
    DrawStyle style;
    bool two_sided = true;
    bool with_colors = false;  ///< vertex colours count
    SurfaceKind kind = SurfaceKind::lit;

    const MeshData& mesh() const { return *object->mesh; }
    bool emits() const { return material.unlit || !material.emissive.isZero(); }
    bool textured() const { return material.has_textures() && !mesh().UV.empty(); }
    bool normal_mapped() const { return bool(material.normal_texture) && !mesh().UV.empty() && !style.flat; }
};

struct DrawList {
    std::vector<DrawItem> meshes;  ///< one per part
    std::vector<DrawItem> points;

    template <class Predicate>
    bool has(Predicate&& predicate) const {
        return std::ranges::any_of(meshes, predicate) || std::ranges::any_of(points, predicate);
    }
    /// The items whose colours may be averaged.
    DrawList without_exact() const;
};

/// All items in the order of the scene. `textures` are the settings' own, which stand in for the materials'.
DrawList draw_list(const SceneSnapshot& scene, const Settings& settings, const Material& textures);

/// A material with the settings' overrides applied.
Material overridden(const Material& material, const MaterialSettings& settings, const Material& textures);

}  // namespace easypbr::render
