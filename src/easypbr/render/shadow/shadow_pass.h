// Draws what a light sees: the depth of the caster that is nearest to it, and what weakens the light on its
// way.
#pragma once

#include <span>
#include <vector>

#include "easypbr/gl/texture.h"
#include "easypbr/gpu/closed_meshes.h"
#include "easypbr/gpu/mesh_buffers.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/raster/visibility.h"
#include "easypbr/render/shadow/shadow_view.h"
#include "easypbr/render/shadow/splat_shadows.h"

namespace easypbr::render {

/// What a map holds where there is no caster: before any depth.
inline constexpr float no_shadow_depth = -1e30f;

class ShadowPass {
  public:
    /// The caches are shared with other passes and must outlive this one.
    ShadowPass(gpu::MeshCache& meshes, gpu::TextureCache& textures, const gpu::ClosedMeshes& closed,
               SplatShadows& splats)
        : meshes_(meshes), textures_(textures), closed_(closed), splats_(splats) {}

    /// Fills one layer with the casters that stop light. Surfaces cast from both sides, masked ones with
    /// their holes.
    void draw(const ShadowView& view, const DrawList& casters, gl::Texture& maps, int layer,
              const gl::Framebuffer& framebuffer);

    /// Fills one layer of the tints with the others, see shaders/shadow_target.glsl: what all of them take
    /// from the light, and where. `framebuffer` has both as attachments.
    void draw_tints(const ShadowView& view, const DrawList& casters, const gl::Framebuffer& framebuffer);

    /// Without a GPU, large opaque meshes and points are rasterised natively; false leaves them to the
    /// driver.
    void allow_native(bool allow) { native_ = allow; }

  private:
    using Items = std::span<const DrawItem>;
    /// Draws what can be drawn natively and uploads the layer; the objects that are left.
    std::vector<Items> draw_native(const ShadowView& view, const std::vector<Items>& objects, Items clouds,
                                   gl::Texture& maps, int layer);
    /// Of solid casters or of the others; without the points that have been drawn natively.
    void draw_splats(const ShadowView& view, const DrawList& casters, bool tints, bool native,
                     int resolution);
    void draw_object(const ShadowView& view, Items items);
    void use_shader(const ShadowView& view, const DrawItem& item);
    /// The same of an item with a shader of its own, whose holes are holes in its shadow.
    void use_own_shader(const ShadowView& view, const DrawItem& item);

    gpu::MeshCache& meshes_;
    gpu::TextureCache& textures_;
    const gpu::ClosedMeshes& closed_;
    SplatShadows& splats_;
    ProgramVariants programs_{"shadow_depth.vert", "shadow_depth.frag"};
    ProgramVariants shaded_{"geometry_mesh.vert", "shadow_shaded.frag"};
    bool native_ = true;
    DepthBuffer depths_;
    VisibilityBuffer points_;
};

}  // namespace easypbr::render
