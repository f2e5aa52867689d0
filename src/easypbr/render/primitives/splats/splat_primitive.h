// 3D Gaussian splats: into the overlay, blended in the order of their depths and hidden by surfaces;
// as surfaces into the G-buffer.
#pragma once

#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/primitives/splats/splat_compositor.h"
#include "easypbr/render/primitives/splats/splat_driver.h"
#include "easypbr/render/primitives/splats/splat_light.h"
#include "easypbr/render/primitives/splats/splat_shadows.h"

namespace easypbr::render {

/// A GPU blends splats where nothing else is between them and they have their own colours, in the order of
/// their means; else they are blended natively, and uploaded where the overlay is a texture. Their colours
/// pass neither light nor tone curve, unless they are relit. Surfaces hide what is behind them; of surfaces
/// that light passes some splats are before and others behind. As surfaces (DrawList:: as_surfaces()) splats
/// are where half of the light is stopped: the normal and index of the splat that does it, and its depth or
/// the expected one.
class SplatPrimitive final : public Primitive {
  public:
    DrawMode mode() const override { return DrawMode::splats; }
    bool is_mean() const override { return true; }
    bool has_driver() const override { return false; }
    void add_mean(const Frame& frame, DrawItems items, std::span<const float> hides,
                  const SurfaceOutputs& outputs, SurfaceWriter& writer) override;
    bool lies_around() const override { return true; }
    void draw_overlay(const Frame& frame, DrawItems items, const GBuffer& targets,
                      const OverlayStep& step) override;

    ShadowShape shadow_shape(const DrawItem& item) override;
    bool has_native_tints(DrawItems) const override { return true; }
    void rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer) override {
        shadows_.rasterise(view, casters, layer);
    }
    void draw_shadows(const ShadowLayer& layer, const Casters& casters) override {
        shadows_.draw(layer, casters);
    }
    void add_to(RayGeometry& geometry, const DrawItem& item) override;
    std::unique_ptr<HitSurface> hit_surface(const ResolvedSettings& resolved, const DrawItem& item) override;
    void set_place_light(const PlaceLight* light) override { light_.set(light); }
    double reach(const DrawItem& item) override { return shadows_.reach(item); }
    ScreenReach screen_reach(const Frame& frame, const DrawItem& item) override;
    void evict_unused() override {
        longest_.evict_unused();
        shadows_.evict_unused();
        driver_.evict_unused();
    }

  private:
    using Limits = SplatCompositor::Limits;

    void begin(const Frame& frame, DrawItems items, const OverlayStep& step);
    void begin_natively(const Frame& frame, bool in_host_memory);
    void draw_over(const Frame& frame, DrawItems items, const GBuffer& targets, const OverlayStep& step);
    bool begin_by_driver(const Frame& frame, const std::vector<const DrawItem*>& items,
                         const OverlayStep& step);
    /// Gives splats the colours that are seen of them, darkened by what hides light from them, or lit.
    SplatSet::Finish colors(const Frame& frame, const std::vector<const DrawItem*>& items);
    SplatSet::Finish own_colors(const Frame& frame, const std::vector<const DrawItem*>& items);
    SplatSet::Finish lit_colors(const Frame& frame, const std::vector<const DrawItem*>& items);
    /// Blends up to the layer that is next, or to what others draw before it.
    void draw_behind(const GBuffer& targets, const OverlayStep& step);
    void draw_front(const GBuffer& targets, const OverlayStep& step);
    /// Takes note of how far splats are drawn in the step: up to `nearest_`, or to `split_` at first.
    void find_limits(const OverlayStep& step);
    /// Blends what lies within the limits into the overlay, which is in host memory or a texture.
    void blend(const GBuffer& targets, const Limits& limits, bool in_host_memory);
    void add(const GBuffer& targets, const Limits& limits);
    void shade(const GBuffer& targets, const Limits& limits);

    SplatCompositor compositor_;
    SplatDriver driver_;
    // Since the beginning.
    std::vector<const DrawItem*> shown_;
    const Target* opaque_ = nullptr;
    bool by_driver_ = false;
    // Reversed depths, see SplatCompositor::Limits; those that are empty are no limits.
    std::vector<float> farthest_;         ///< before which splats are still to be drawn
    std::vector<float> nearest_, split_;  ///< of the step
    bool is_split_ = false;               ///< in some pixel others lie between splats of the step
    Target picture_;                      ///< RGBA16F: what is uploaded
    SplatShadows shadows_;
    RevisionCache<uint64_t, double> longest_;  ///< of all axes, by the revision of the scales
    SplatLight light_;
    ProgramVariants programs_{"screen_triangle.vert", "overlay_splats.frag"};
};

}  // namespace easypbr::render
