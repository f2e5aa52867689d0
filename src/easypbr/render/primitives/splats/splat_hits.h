// Splats where rays meet them: they shine in their colours, or as they are lit.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/inverse_tone.h"
#include "easypbr/render/primitives/hit_surface.h"
#include "easypbr/render/primitives/splats/splat_light.h"

namespace easypbr::render {

/// Their colours are those of the image: what is seen of them in a mirror passes exposure and tone curve, so
/// that they shine with what becomes their colours by them. The normals of the hits are opposite to the rays.
class SplatHits final : public HitSurface {
  public:
    /// The item must outlive this, and so must what darkens it.
    SplatHits(const DrawItem& item, const ResolvedSettings& resolved, SplatLight& light)
        : item_(item),
          tone_(display_tone(resolved)),
          light_(light),
          are_lit_(SplatLight::relights(resolved)),
          parts_(light.parts_of(item, are_lit_)) {}
    void shade(std::span<const native::ElementHit> hits, const native::HitSurfaces& surfaces) const override;

  private:
    struct Shown {
        Vec3 albedo, emission;
    };
    Shown shown(Eigen::Index splat, const Vec3& normal) const;

    const DrawItem& item_;
    DisplayTone tone_;
    const SplatLight& light_;
    bool are_lit_;
    std::shared_ptr<SplatLight::Parts> parts_;
};

}  // namespace easypbr::render
