// Columns and rows as numbers, no farther out than they matter. std::floor() is a call for processors without
// SSE4.1, which takes as long as all else that is done for a small splat.
#pragma once

#include <algorithm>

namespace easypbr::render {

inline int floor_of(float place) {
    const float near = std::clamp(place, -1e6f, 1e6f);
    const int towards_zero = int(near);
    return towards_zero - int(near < float(towards_zero));
}
inline int ceil_of(float place) {
    return -floor_of(-place);
}

}  // namespace easypbr::render
