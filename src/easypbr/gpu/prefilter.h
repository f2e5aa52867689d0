// Image-based lighting: what the GPU needs of an environment, computed on the CPU in parallel and cached on
// disk.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/scene/environment.h"

namespace easypbr::gpu {

/// What an image is divided by before it is stored as halves: 1, and another power of two where its brightest
/// value is beyond their range or near its lower end.
float half_scale(const Image& image);

/// Radiance prefiltered for GGX and irradiance, both divided by `scale`, as cube maps of halves (RGBA). Faces
/// in OpenGL's order (+x -x +y -y +z -z), rows as OpenGL stores them.
struct PrefilteredEnvironment {
    static constexpr int base_size = 256;  ///< side of level 0
    static constexpr int level_count = 6;  ///< 256 .. 8
    static constexpr int irradiance_size = 16;

    std::vector<std::vector<uint16_t>> radiance;  ///< per level: 6 faces x size x size x 4
    std::vector<uint16_t> irradiance;             ///< 6 x 16 x 16 x 4, irradiance / pi
    float scale = 1;                              ///< half_scale() of the environment's image
};

/// Perceptual roughness of a level: the inverse of lod = r (2 - r) (level_count - 1), which gives smooth
/// surfaces more levels. Level 0 is the environment itself.
float roughness_of_level(int level);

/// Split-sum prefiltering with N = V = R (Karis 2013), filtered importance sampling (Krivanek and Colbert
/// 2008).
PrefilteredEnvironment prefilter(const Environment& environment);

/// The same, from the disk cache when it is there.
PrefilteredEnvironment prefilter_cached(const Environment& environment);

}  // namespace easypbr::gpu
