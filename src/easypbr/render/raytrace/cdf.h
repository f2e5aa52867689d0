// Discrete distributions by their cumulative distribution function (CDF).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace easypbr::render {

/// Where a number in [0, 1) is within a step of a CDF, 0 to 1.
inline float within_step(std::span<const float> ends, size_t step, float at) {
    const float begin = step == 0 ? 0 : ends[step - 1];
    return std::clamp((at - begin) / std::max(ends[step] - begin, 1e-20f), 0.0f, 1.0f);
}

/// The step of a CDF that holds a number in [0, 1); `within`: where in the step, 0 to 1.
inline size_t step_of(std::span<const float> ends, float at, float& within) {
    const auto found = std::min(std::upper_bound(ends.begin(), ends.end(), at), ends.end() - 1);
    const auto step = size_t(found - ends.begin());
    within = within_step(ends, step, at);
    return step;
}

/// The step that holds each multiple of 1 / ends.size(), from which a search starts (Chen and Asau 1974): on
/// the mean it goes two steps. At most 65536 steps.
inline void add_guide(std::span<const float> ends, std::vector<uint16_t>& guide) {
    size_t step = 0;
    for (size_t k = 0; k < ends.size(); ++k) {
        while (step + 1 < ends.size() && ends[step] * float(ends.size()) <= float(k)) ++step;
        guide.push_back(uint16_t(step));
    }
}

/// Which of `count` places of a guide a number in [0, 1) looks up.
inline size_t guide_place(size_t count, float at) {
    return std::min(size_t(at * float(count)), count - 1);
}

/// As step_of() without a guide.
inline size_t step_of(std::span<const float> ends, std::span<const uint16_t> guide, float at, float& within) {
    size_t step = guide[guide_place(ends.size(), at)];
    while (step > 0 && ends[step - 1] > at) --step;
    while (step + 1 < ends.size() && ends[step] <= at) ++step;
    within = within_step(ends, step, at);
    return step;
}

}  // namespace easypbr::render
