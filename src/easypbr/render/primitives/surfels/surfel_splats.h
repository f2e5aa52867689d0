// The driver's three steps of surface splatting, for surfels of the G-buffer and of layers.
#pragma once

#include <span>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/surfels/surfel_buffers.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

/// Nearest distance, weighted sums of what lies within a band behind it, quotients (Botsch et al. 2005,
/// "High-Quality Surface Splatting on Today's GPUs"). Quads and ellipses take the place of the paper's
/// geometry shader. Of a layer it may be the farthest distance and what lies within a band before it.
class SurfelSplats {
  public:
    /// The caches are shared with other passes, must outlive this one, and are emptied by their owner.
    SurfelSplats(SpacingCache& spacings, SurfelCache& surfels) : spacings_(spacings), cache_(surfels) {}

    /// The first two steps, for all items together. Left out is what lies behind `limit` (R32F, reversed
    /// depth), and, of a layer, at it.
    void sum(const Frame& frame, std::span<const DrawItem> items, const gl::Texture& limit,
             const SurfaceOutputs& outputs);

    /// The third, into the framebuffer that is bound: what GBuffer::surface_emission or, with ids,
    /// surface_ids hold. Of a layer, target 5 gets `owner` and where in reversed depth the pixel's band ends.
    void write(const Frame& frame, const SurfaceOutputs& outputs, int owner = 0);

    double spacing_of(const DrawItem& item) {
        return item.mesh().T.empty() ? spacings_.get(item.mesh().V) : 0;
    }

  private:
    void make_targets(const Frame& frame, bool ids);
    void draw_item(const Frame& frame, const DrawItem& item, const SurfaceOutputs& outputs, bool accumulate);

    SpacingCache& spacings_;
    SurfelCache& cache_;
    gl::Texture albedo_sum_, normal_sum_, material_sum_, depth_, id_, element_;
    gl::Framebuffer visibility_, visibility_ids_, sums_;
    ProgramVariants splats_{"geometry_surfels.vert", "geometry_surfels.frag"};
    ProgramVariants quotients_{"screen_triangle.vert", "normalise_surfels.frag"};
};

}  // namespace easypbr::render
