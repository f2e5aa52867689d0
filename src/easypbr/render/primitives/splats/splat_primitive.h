// 3D Gaussian splats: into the overlay, unlit, blended in the order of their depths and hidden by surfaces;
// as surfaces into the G-buffer.
#pragma once

#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/primitives/splats/splat_compositor.h"

namespace easypbr::render {

/// Splats are blended natively on every device; where the overlay is a texture they are uploaded. Their
/// colours pass neither light nor tone curve. A splat is hidden where a surface is nearer than it is densest;
/// of surfaces that light passes some splats are before and others behind. As surfaces (DrawList::
/// as_surfaces()) splats are where half of the light is stopped: the depth, normal and index of the splat
/// that does it.
class SplatPrimitive final : public Primitive {
  public:
    DrawMode mode() const override { return DrawMode::splats; }
    bool is_mean() const override { return true; }
    bool has_driver() const override { return false; }
    void add_mean(const Frame& frame, DrawItems items, std::span<const float> hides,
                  SurfaceWriter& writer) override;
    void begin_overlay(const Frame& frame, DrawItems items, const GBuffer& targets,
                       const gl::Texture& opaque) override;
    void draw_overlay_behind(const Frame& frame, DrawItems items, const GBuffer& targets,
                             const GBuffer& layer) override;
    void draw_overlay_rest(const Frame& frame, DrawItems items, const GBuffer& targets) override;
    void draw_overlay_over(const Frame& frame, DrawItems items, const GBuffer& targets) override;
    void shade_overlay(const Frame& frame, DrawItems items, const GBuffer& targets,
                       Transfers& transfers) override;

  private:
    /// Blends what lies within the limits into the overlay's texture.
    void add(const GBuffer& targets, const SplatCompositor::Limits& limits);
    /// The same in host memory.
    void shade(const GBuffer& targets, const SplatCompositor::Limits& limits);

    SplatCompositor compositor_;
    std::vector<float> farthest_;  ///< reversed depths before which splats are still to be drawn
    Target picture_;               ///< RGBA16F: what is uploaded
    ProgramVariants programs_{"screen_triangle.vert", "overlay_splats.frag"};
};

}  // namespace easypbr::render
