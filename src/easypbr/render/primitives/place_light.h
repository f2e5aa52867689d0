// The light that reaches places that are no surfaces.
#pragma once

#include <cstdint>

#include "easypbr/core/math.h"

namespace easypbr::render {

class PlaceLight {
  public:
    virtual ~PlaceLight() = default;
    /// The part of the light of lamps and sky that the scene's surfaces leave to a place with this normal
    /// (unit): 1 where all of it arrives, and where there is none. World space. `number` is of the place:
    /// places have random directions of their own. Safe to call from several threads.
    virtual float part_at(const Vec3d& place, const Vec3d& normal, uint32_t number) const = 0;
    /// What arrives of that light: the radiance of a white matt surface, scene-linear, before exposure.
    virtual Vec3 light_at(const Vec3d& place, const Vec3d& normal, uint32_t number) const = 0;
    /// Another one each time that anything has changed.
    virtual uint64_t generation() const = 0;
};

}  // namespace easypbr::render
