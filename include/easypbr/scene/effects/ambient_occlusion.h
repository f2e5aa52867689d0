// Settings of screen-space ambient occlusion.
#pragma once

#include "easypbr/scene/auto.h"

namespace easypbr {

enum class OcclusionMethod { horizon, hemisphere };
enum class OcclusionResolution { adaptive, half, full };

/// Screen-space ambient occlusion of image-based lighting.
template <template <class> class MaybeAuto>
struct BasicSsaoSettings {
    MaybeAuto<bool> enabled{};  ///< automatic: on if the scene has faces, normals or voxels
    OcclusionMethod method = OcclusionMethod::horizon;
    OcclusionResolution resolution = OcclusionResolution::adaptive;  ///< adaptive: full from 48 samples on
    MaybeAuto<float> radius{};  ///< of occluders at most, world units; automatic: 5 % of the diagonal
    float falloff = 0.6f;       ///< outer fraction of the radius over which occlusion fades, 0.01 to 1
    float power = 1;            ///< exponent of the visibility, 0 to 16
    int directions = 1;         ///< slices, or sets of points, per pixel and sample, 1 to 64
    int steps = 6;              ///< depth-buffer samples per direction and side, 1 to 64
    bool multi_bounce = true;   ///< approximates multiple bounces, which lighten occlusion by the albedo
};
using SsaoSettings = BasicSsaoSettings<Auto>;

}  // namespace easypbr
