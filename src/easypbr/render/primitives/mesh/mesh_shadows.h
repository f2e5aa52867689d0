// Meshes as casters of shadows.
#pragma once

#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/caches.h"
#include "easypbr/render/primitives/mesh/mesh_buffers.h"
#include "easypbr/render/primitives/shadow_layer.h"

namespace easypbr::render {

/// Surfaces cast from both sides, masked ones with their holes.
class MeshShadows {
  public:
    /// The caches are shared with others, must outlive this one, and are emptied by their owner.
    MeshShadows(MeshCache& meshes, DataCaches& caches)
        : meshes_(meshes), textures_(caches.textures), closed_(caches.closed_meshes) {}

    /// See Primitive. Large objects that are opaque are rasterised.
    void rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths) const;
    void draw(const ShadowLayer& layer, const Casters& casters);

  private:
    void use_shader(const ShadowLayer& layer, const DrawItem& item);
    /// The same of an item with a shader of its own, whose holes are holes in its shadow.
    void use_own_shader(const ShadowLayer& layer, const DrawItem& item);

    MeshCache& meshes_;
    gpu::TextureCache& textures_;
    const gpu::ClosedMeshes& closed_;
    ProgramVariants programs_{"shadow_depth.vert", "shadow_depth.frag"};
    ProgramVariants shaded_{"geometry_mesh.vert", "shadow_shaded.frag"};
};

}  // namespace easypbr::render
