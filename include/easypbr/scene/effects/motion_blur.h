// Settings of motion blur.
#pragma once

namespace easypbr {

/// Motion blur of accumulated images, by the time of each sample.
struct MotionBlurSettings {
    bool enabled = false;
    float shutter = 0.5f;  ///< fraction of the time since the previous image that the shutter is open, 0 to 1
};

}  // namespace easypbr
