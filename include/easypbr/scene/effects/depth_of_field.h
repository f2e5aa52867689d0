// Settings of the thin lens.
#pragma once

#include "easypbr/scene/auto.h"

namespace easypbr {

/// Depth of field of a thin lens; perspective cameras only.
template <template <class> class MaybeAuto>
struct BasicDepthOfFieldSettings {
    bool enabled = false;
    float f_number = 2.8f;               ///< focal length / aperture diameter, 0.1 to 1000
    MaybeAuto<double> focus_distance{};  ///< along the axis, world units; automatic: the content's centre
    MaybeAuto<double> sensor_height{};   ///< world units; automatic: 5 % of the content's diagonal
};
using DepthOfFieldSettings = BasicDepthOfFieldSettings<Auto>;

}  // namespace easypbr
