// Surfels that light passes, in layers beside other surfaces.
#pragma once

#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/surfels/surfel_splats.h"

namespace easypbr::render {

/// Splats that overlap are one surface, which weakens what is behind it once, and not once each. Of an item
/// that is the farthest splat along a pixel's ray and all that lie within its size before it: their weighted
/// mean is one layer. Each item keeps where its last layer ended, so that items count apart however near they
/// are.
///
///     begin(frame, items, opaque depth);
///     for each layer of TransparencyPass, once all other surfaces are in it:
///         draw(frame, items, layer);
///         take(items);
class SurfelLayers {
  public:
    explicit SurfelLayers(SurfelSplats& splats) : splats_(splats) {}

    /// Nothing behind `opaque` (R32F, reversed depth) is drawn.
    void begin(const Frame& frame, std::span<const DrawItem> items, const gl::Texture& opaque);
    /// Adds each item's next surface where it is farther than what the layer holds (in the last layer:
    /// nearer).
    void draw(const Frame& frame, std::span<const DrawItem> items, const GBuffer& layer,
              const SurfaceOutputs& outputs);
    /// What the layer took of each item is not drawn again.
    void take(std::span<const DrawItem> items);

  private:
    struct Limit {
        gl::Texture depth;  ///< R32F, reversed: the band of the last layer's splats ends there
        gl::Framebuffer framebuffer;
    };

    SurfelSplats& splats_;
    gl::Texture
        claim_;  ///< RGBA32F, r: 1 + place of the item whose surface the layer holds; g: its band's end
    gl::Framebuffer layer_;
    std::vector<Limit> limits_;  ///< one for each item
    ProgramVariants take_{"screen_triangle.vert", "surfel_limit.frag"};
};

}  // namespace easypbr::render
