// Settings of path tracing.
#pragma once

#include "easypbr/scene/auto.h"

namespace easypbr {

/// Light by path tracing on the CPU, from the surfaces that the frame shows: all that lights, the environment
/// and other surfaces send, in place of shadow maps, ambient occlusion and the split sum. Averages of many
/// samples converge to the solution of the rendering equation (Kajiya 1986).
template <template <class> class MaybeAuto>
struct BasicPathSettings {
    MaybeAuto<bool> enabled{};  ///< automatic: off
    int bounces = 8;            ///< surfaces that a path meets after the one that is seen, 0 to 64
    float clamp = 10;           ///< most luminance that a path adds beyond direct light, 0: unlimited
};
using PathSettings = BasicPathSettings<Auto>;

}  // namespace easypbr
