// Whether the parts of an animation rig fit together.
#pragma once

#include "easypbr/scene/animation.h"

namespace easypbr {

/// Throws ArgumentError that names what is wrong: an index of what does not exist, keys as require_keys()
/// says, deformations as check_deformation() says, a duration that is negative or not finite, no pose at rest
/// for a joint, or no function for the values of a material, a light or a camera. Whether nodes are their own
/// descendants it does not look at.
void check_rig(const AnimationRig& rig);

}  // namespace easypbr
