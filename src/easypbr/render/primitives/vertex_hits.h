// Surfaces of elements that are each of one colour, as points are.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/primitives/hit_surface.h"

namespace easypbr::render {

class VertexHits final : public HitSurface {
  public:
    /// The item must outlive this.
    explicit VertexHits(const DrawItem& item) : item_(item) {}
    void shade(std::span<const native::ElementHit> hits, const native::HitSurfaces& surfaces) const override;

  private:
    const DrawItem& item_;
};

}  // namespace easypbr::render
