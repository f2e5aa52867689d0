// What denoising knows of pixels with path traced layers.
#pragma once

#include <cstdint>

#include "easypbr/render/frame/gbuffer.h"

namespace easypbr::render {

/// The surfaces of a frame as its layers change them, in host memory: base colour, metallic and roughness are
/// blended as light is, and normal and depth are those of whatever hides most. Alpha of the base colour is
/// the coverage, but for what paths find by chance: shadows on a catcher behind, or the background through
/// glass.
class LayerGuides {
  public:
    /// Of the surfaces behind all layers. `over_nothing`: the background has no radiance. Another one is
    /// taken for a white surface.
    void begin(const GBuffer& targets, bool over_nothing, Transfers& transfers);
    /// The next layer, from the farthest to the nearest, in host memory.
    void add(const GBuffer& layer);
    const GBuffer& surfaces() const { return guides_; }

  private:
    GBuffer guides_;
    bool over_nothing_ = true;
};

}  // namespace easypbr::render
