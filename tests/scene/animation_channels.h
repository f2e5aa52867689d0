// Channels of animations in one expression.
#pragma once

#include <utility>
#include <vector>

#include "easypbr/scene/animation.h"

namespace easypbr {

inline AnimationChannel channel(Interpolation interpolation, std::vector<float> times, ArrayXf::Dense values,
                                AnimatedProperty property = AnimatedProperty::translation) {
    AnimationChannel out;
    out.property = property;
    out.interpolation = interpolation;
    out.times = std::move(times);
    out.values = std::move(values);
    return out;
}

}  // namespace easypbr
