// Surfels into the G-buffer: surface splatting in the paper's three steps.
#pragma once

#include "easypbr/gpu/surfel_buffers.h"
#include "easypbr/render/draw_list.h"
#include "easypbr/render/frame.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/native_pixels.h"
#include "easypbr/render/programs.h"
#include "easypbr/render/software_surfels.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

/// Nearest distance, weighted sums of what lies within a band behind it, quotients (Botsch et al. 2005,
/// "High-Quality Surface Splatting on Today's GPUs"). Quads and ellipses take the place of the paper's
/// geometry shader.
class SurfelPass {
  public:
    /// The caches are shared with other passes, must outlive this one, and are emptied by their owner.
    SurfelPass(SpacingCache& spacings, gpu::SurfelCache& surfels) : spacings_(spacings), cache_(surfels) {}

    /// Adds the surfels to what the G-buffer holds; natively, which is faster where there is no GPU, or by
    /// the driver.
    void draw(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets, bool native);

  private:
    void draw_natively(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets);
    void make_targets(const Frame& frame);
    void draw_items(const Frame& frame, const std::vector<DrawItem>& items, bool accumulate);
    void normalise(const Frame& frame, const GBuffer& targets);
    double spacing_of(const DrawItem& item) {
        return item.mesh().T.empty() ? spacings_.get(item.mesh().V) : 0;
    }

    SpacingCache& spacings_;
    gpu::SurfelCache& cache_;
    gl::Texture albedo_sum_, normal_sum_, material_sum_, depth_, id_, element_;
    gl::Framebuffer visibility_, visibility_ids_, sums_;
    ProgramVariants splats_{"geometry_surfels.vert", "geometry_surfels.frag"};
    ProgramVariants quotients_{"screen_triangle.vert", "normalise_surfels.frag"};
    gl::VertexArray no_attributes_;

    SoftwareSurfels software_;
    NativePixels pixels_;
    SurfaceComposite composite_;
};

}  // namespace easypbr::render
