// Draws what a light sees: the depth of the caster that is nearest to it.
#pragma once

#include "easypbr/gl/texture.h"
#include "easypbr/gpu/mesh_buffers.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/draw_list.h"
#include "easypbr/render/programs.h"
#include "easypbr/render/shadow_view.h"

namespace easypbr::render {

/// What a map holds where there is no caster: before any depth.
inline constexpr float no_shadow_depth = -1e30f;

class ShadowPass {
  public:
    /// The caches are shared with other passes and must outlive this one.
    ShadowPass(gpu::MeshCache& meshes, gpu::TextureCache& textures) : meshes_(meshes), textures_(textures) {}

    /// Fills one map. Surfaces cast from both sides, masked ones with their holes, blended ones where
    /// frame `sample_index` of a still draws them.
    void draw(const ShadowView& view, const DrawList& casters, int sample_index, const gl::Framebuffer& map);

  private:
    void draw_item(const ShadowView& view, const DrawItem& item, int sample_index);

    gpu::MeshCache& meshes_;
    gpu::TextureCache& textures_;
    ProgramVariants programs_{"shadow_depth.vert", "shadow_depth.frag"};
};

}  // namespace easypbr::render
