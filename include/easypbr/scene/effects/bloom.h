// Settings of bloom.
#pragma once

#include "easypbr/scene/auto.h"

namespace easypbr {

/// Bloom, applied in linear HDR before tone mapping. Conserves energy.
template <template <class> class MaybeAuto>
struct BasicBloomSettings {
    bool enabled = false;
    float intensity = 0.2f;   ///< fraction of the light above the threshold that is scattered, 0 to 1
    float threshold = 1;      ///< on the largest of red, green and blue after exposure; 0: all light
    float knee = 0.5f;        ///< width of the soft knee as a fraction of the threshold, 0 to 1
    MaybeAuto<int> levels{};  ///< mip levels of the pyramid, 1 to 8; automatic: by the image size
    MaybeAuto<bool> suppress_fireflies{};  ///< weights bright pixels down; automatic: threshold > 0
};
using BloomSettings = BasicBloomSettings<Auto>;

}  // namespace easypbr
