// Settings of ray-traced visibility and reflections.
#pragma once

#include "easypbr/scene/auto.h"

namespace easypbr {

/// Sky visibility and indirect light by ray tracing on the CPU, in place of ambient occlusion.
template <template <class> class MaybeAuto>
struct BasicRaySettings {
    MaybeAuto<bool> enabled{};  ///< automatic: from 32 samples on, if ssao.enabled
    int count = 256;            ///< diffuse rays per pixel of an image, over all samples, 1 to 65536
};
using RaySettings = BasicRaySettings<Auto>;

}  // namespace easypbr
