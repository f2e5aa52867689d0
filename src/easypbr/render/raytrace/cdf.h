// Discrete distributions by their cumulative distribution function (CDF).
#pragma once

#include <algorithm>
#include <span>

namespace easypbr::render {

/// The step of a CDF that holds a number in [0, 1); `within`: where in the step, 0 to 1.
inline size_t step_of(std::span<const float> ends, float at, float& within) {
    const auto found = std::min(std::upper_bound(ends.begin(), ends.end(), at), ends.end() - 1);
    const float begin = found == ends.begin() ? 0 : *(found - 1);
    within = std::clamp((at - begin) / std::max(*found - begin, 1e-20f), 0.0f, 1.0f);
    return size_t(found - ends.begin());
}

}  // namespace easypbr::render
