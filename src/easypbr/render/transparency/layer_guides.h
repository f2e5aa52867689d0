// What denoising knows of pixels with path traced layers.
#pragma once

#include <cstdint>

#include "easypbr/render/frame/gbuffer.h"

namespace easypbr::render {

/// The surfaces of a frame as its layers change them, in host memory: base colour, metallic and roughness are
/// blended as light is, and normal and depth are those of whatever hides most.
class LayerGuides {
  public:
    /// Of the surfaces behind all layers.
    void begin(const GBuffer& targets, Transfers& transfers);
    /// The next layer, from the farthest to the nearest, in host memory.
    void add(const GBuffer& layer);
    const GBuffer& surfaces() const { return guides_; }

  private:
    GBuffer guides_;
};

}  // namespace easypbr::render
