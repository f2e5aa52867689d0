// Surfaces of items where rays meet them.
#pragma once

#include <span>

#include "easypbr/native/kernels.h"

namespace easypbr::render {

/// An item with all that rays need that meet it.
class HitSurface {
  public:
    virtual ~HitSurface() = default;
    /// Writes the surfaces of some hits. Called from several threads; the arrays have room for a multiple of
    /// native::stream_alignment.
    virtual void shade(std::span<const native::ElementHit> hits,
                       const native::HitSurfaces& surfaces) const = 0;
};

}  // namespace easypbr::render
