// What the keys of an animation must be.
#pragma once

#include "easypbr/scene/animation.h"

namespace easypbr {

/// Throws ArgumentError that names what was expected and what was got, unless a channel has finite rising
/// times, and finite values in as many rows and columns as its times, interpolation and property need. Which
/// channel it is the caller has to add.
void require_keys(const AnimationChannel& channel);

}  // namespace easypbr
