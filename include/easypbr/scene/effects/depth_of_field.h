// Settings of the thin lens.
#pragma once

#include "easypbr/scene/auto.h"

namespace easypbr {

/// Depth of field of a thin lens; perspective cameras only.
struct DepthOfFieldSettings {
    bool enabled = false;
    float f_number = 2.8f;        ///< focal length / aperture diameter, 0.1 to 1000
    Auto<double> focus_distance;  ///< along the optical axis, world units; automatic: the content's centre
    Auto<double> sensor_height;   ///< world units; automatic: 5 % of the content's diagonal
};

}  // namespace easypbr
