// Splats where rays meet them: they shine in their colours.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/primitives/hit_surface.h"
#include "easypbr/render/primitives/splats/splat_light.h"

namespace easypbr::render {

/// Their colours are those of the picture: what is seen of them in a mirror passes exposure and tone curve
/// once more, so that they are divided by the exposure. The normals of the hits are opposite to the rays.
class SplatHits final : public HitSurface {
  public:
    /// The item must outlive this, and so must what darkens it.
    SplatHits(const DrawItem& item, float exposure, SplatLight& light)
        : item_(item), exposure_(exposure), light_(light), parts_(light.parts_of(item)) {}
    void shade(std::span<const native::ElementHit> hits, const native::HitSurfaces& surfaces) const override;

  private:
    const DrawItem& item_;
    float exposure_;
    const SplatLight& light_;
    std::shared_ptr<SplatLight::Parts> parts_;
};

}  // namespace easypbr::render
