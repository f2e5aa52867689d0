// What a frame draws: one item per part of each visible object, with its final material and style.
#pragma once

#include <vector>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {

struct DrawItem {
    const SceneSnapshot::Object* object = nullptr;
    MeshPart part;
    Material material;  ///< with the settings' overrides
    bool flat = false;
    bool two_sided = true;
    bool with_colors = false;  ///< vertex colours count

    const MeshData& mesh() const { return *object->mesh; }
    bool emits() const { return material.unlit || !material.emissive.isZero(); }
    bool textured() const { return material.has_textures() && !mesh().UV.empty(); }
    bool normal_mapped() const { return bool(material.normal_texture) && !mesh().UV.empty() && !flat; }
};

/// All items in the order of the scene. `textures` are the settings' own, which stand in for the materials'.
std::vector<DrawItem> draw_list(const SceneSnapshot& scene, const Settings& settings,
                                const Material& textures);

/// A material with the settings' overrides applied.
Material overridden(const Material& material, const MaterialSettings& settings, const Material& textures);

}  // namespace easypbr::render
