// Point clouds.
#pragma once

#include "easypbr/render/primitives/points/point_order.h"
#include "easypbr/render/primitives/points/point_pass.h"
#include "easypbr/render/primitives/points/point_shadows.h"
#include "easypbr/render/primitives/primitive.h"

namespace easypbr::render {

class PointPrimitive final : public Primitive {
  public:
    explicit PointPrimitive(DataCaches& caches)
        : spacings_(caches.spacings), pass_(spacings_, buffers_), shadows_(spacings_, buffers_) {}

    DrawMode mode() const override { return DrawMode::points; }
    void draw(const Frame& frame, DrawItems items, const GBuffer& targets,
              const SurfaceOutputs& outputs) override {
        pass_.draw(frame, items, targets, outputs);
    }
    bool is_native(DrawItems items) const override;
    bool rasterise(const Frame& frame, DrawItems items, ExtensionSet extensions,
                   VisibleSurfaces& surfaces) override;
    bool has_native_layers(DrawItems) const override { return true; }
    bool cover(const Frame& frame, DrawItems items, std::span<uint8_t> covered) override;
    ShadowShape shadow_shape(const DrawItem& item) override;
    void rasterise_shadows(const ShadowView& view, Casters& casters, ShadowDepths& depths) override {
        shadows_.rasterise(view, casters, depths);
    }
    bool has_native_tints(DrawItems) const override { return true; }
    void rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer) override {
        shadows_.rasterise_tints(view, casters, layer);
    }
    void draw_shadows(const ShadowLayer& layer, const Casters& casters) override {
        shadows_.draw(layer, casters);
    }
    void add_to(RayGeometry& geometry, const DrawItem& item) override {
        geometry.add_discs(item, shadows_.radius(item));
    }
    double reach(const DrawItem& item) override { return shadows_.radius(item); }
    ScreenReach screen_reach(const Frame& frame, const DrawItem& item) override;
    int reach_in_pixels(const DrawStyle& style) const override;
    void evict_unused() override {
        buffers_.evict_unused();
        batches_.evict_unused();
    }

  private:
    SpacingCache& spacings_;
    PointCache buffers_;
    BatchedClouds batches_;
    PointPass pass_;
    PointShadows shadows_;
};

}  // namespace easypbr::render
