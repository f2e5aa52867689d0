// A light of which everything is known.
#pragma once

#include "easypbr/scene/light.h"

namespace easypbr {

/// A light as it is drawn. See Light for the radius, which directional lights do not have.
struct ResolvedLight : LightSource {
    float radius = 0;

    ResolvedLight() = default;
    ResolvedLight(const LightSource& source, float given_radius)
        : LightSource(source), radius(given_radius) {}

    bool operator==(const ResolvedLight& other) const = default;
};

}  // namespace easypbr
