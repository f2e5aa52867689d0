// Surfels: oriented ellipses, of which those that overlap are one surface.
#pragma once

#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/primitives/surfels/software_surfels.h"
#include "easypbr/render/primitives/surfels/surfel_layers.h"
#include "easypbr/render/primitives/surfels/surfel_shadows.h"
#include "easypbr/render/primitives/surfels/surfel_splats.h"

namespace easypbr::render {

class SurfelPrimitive final : public Primitive {
  public:
    explicit SurfelPrimitive(DataCaches& caches)
        : splats_(caches.spacings, buffers_), layers_(splats_), shadows_(caches.spacings, buffers_) {}

    DrawMode mode() const override { return DrawMode::surfels; }
    /// What is nearest at a pixel and within a band behind it is one surface, of whatever item; or what is
    /// nearest alone (SurfaceOutputs::nearest_alone).
    void draw(const Frame& frame, DrawItems items, const GBuffer& targets,
              const SurfaceOutputs& outputs) override;
    bool is_native(DrawItems) const override { return true; }
    bool is_mean() const override { return true; }
    void add_mean(const Frame& frame, DrawItems items, std::span<const float> hides,
                  const SurfaceOutputs& outputs, SurfaceWriter& writer) override;
    bool has_native_layers(DrawItems) const override { return true; }
    void begin_mean_layers(const Frame& frame, DrawItems items, std::span<const float> opaque) override {
        layer_sources_ = sources_of(frame, items);
        software_.begin_layers(frame, layer_sources_, opaque);
    }
    bool add_mean_layer(const Frame& frame, DrawItems, PeelLimits& limits, SurfaceWriter& writer) override {
        return software_.add_layer(frame, layer_sources_, limits, writer);
    }
    void begin_layers(const Frame& frame, DrawItems items, const gl::Texture& opaque) override {
        layers_.begin(frame, items, opaque);
    }
    void draw_layer(const Frame& frame, DrawItems items, const GBuffer& layer,
                    const SurfaceOutputs& outputs) override {
        layers_.draw(frame, items, layer, outputs);
    }
    void take_layer(DrawItems items) override { layers_.take(items); }
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
    void add_to(RayGeometry& geometry, const DrawItem& item) override;
    double reach(const DrawItem& item) override { return shadows_.reach(item); }
    ScreenReach screen_reach(const Frame& frame, const DrawItem& item) override;
    void evict_unused() override {
        buffers_.evict_unused();
        batches_.evict_unused();
        shadows_.evict_unused();
    }

  private:
    std::vector<SurfelSource> sources_of(const Frame& frame, DrawItems items);

    SurfelCache buffers_;
    BatchedSurfels batches_;
    std::vector<SurfelSource> layer_sources_;  ///< of begin_mean_layers()
    SurfelSplats splats_;
    SurfelLayers layers_;
    SoftwareSurfels software_;
    SurfelShadows shadows_;
};

}  // namespace easypbr::render
