// Meshes as casters of shadows.
#pragma once

#include <span>

#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/caches.h"
#include "easypbr/render/primitives/mesh/caster_surface.h"
#include "easypbr/render/primitives/mesh/mesh_buffers.h"
#include "easypbr/render/primitives/mesh/native_meshes.h"
#include "easypbr/render/primitives/shadow_layer.h"

namespace easypbr::render {

/// Surfaces cast from both sides, masked ones with their holes.
class MeshShadows {
  public:
    /// The caches are shared with others, must outlive this one, and are emptied by their owner.
    MeshShadows(MeshCache& meshes, NativeMeshes& native, DataCaches& caches)
        : meshes_(meshes), native_(native), textures_(caches.textures), closed_(caches.closed_meshes) {}

    /// See Primitive. What has no shader of its own is rasterised.
    void rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths);
    static bool has_native_tints(std::span<const DrawItem> items);
    void rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer);
    void draw(const ShadowLayer& layer, const Casters& casters);

  private:
    /// Whether it has drawn the opaque ones of an object's parts.
    bool rasterise_opaque(const ShadowView& view, std::span<const DrawItem* const> parts,
                          ShadowDepths& depths) const;
    void rasterise_masked(const ShadowView& view, const DrawItem& item, ShadowDepths& depths);
    CasterSurface surface_of(const ShadowView& view, int resolution, const DrawItem& item);
    /// Of a caster that light passes.
    gpu::Winding winding_of(const DrawItem& item);
    void use_shader(const ShadowLayer& layer, const DrawItem& item);
    /// The same of an item with a shader of its own, whose holes are holes in its shadow.
    void use_own_shader(const ShadowLayer& layer, const DrawItem& item);

    MeshCache& meshes_;
    NativeMeshes& native_;
    gpu::TextureCache& textures_;
    gpu::ClosedMeshes& closed_;
    VisibilityBuffer masked_;
    ProgramVariants programs_{"shadow_depth.vert", "shadow_depth.frag"};
    ProgramVariants shaded_{"geometry_mesh.vert", "shadow_shaded.frag"};
};

}  // namespace easypbr::render
