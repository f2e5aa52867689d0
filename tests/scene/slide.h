// An animation whose place at each time is plain.
#pragma once

#include <string>

#include "easypbr/scene/animation.h"

namespace easypbr {

/// Its node goes 2 units along x in 4 seconds.
inline Animation slide(const std::string& name) {
    Animation slide;
    slide.name = name;
    slide.duration_s = 4;
    AnimationChannel channel;
    channel.times = {0, 4};
    channel.values = ArrayXf::Dense{{0, 0, 0}, {2, 0, 0}};
    slide.channels = {channel};
    return slide;
}

}  // namespace easypbr
