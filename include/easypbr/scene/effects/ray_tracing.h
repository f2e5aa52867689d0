// Settings of ray-traced visibility and reflections, and of path tracing.
#pragma once

#include "easypbr/scene/auto.h"

namespace easypbr {

/// Sky visibility and indirect light by ray tracing on the CPU, in place of ambient occlusion.
template <template <class> class MaybeAuto>
struct BasicRaySettings {
    MaybeAuto<bool> enabled{};  ///< automatic: from 32 samples on, if ssao.enabled and no paths are traced
    int count = 256;            ///< diffuse rays per pixel of an image, over all samples, 1 to 65536
};
using RaySettings = BasicRaySettings<Auto>;

/// How the noise of path traced pictures is taken out: by Intel Open Image Denoise, by a filter of our own,
/// or not. Best: by the first where it is there, else by the second; scene-linear pictures are left as they
/// are where path.enabled was turned on.
enum class Denoising { best, oidn, filter, off };

/// Light by path tracing on the CPU, from the surfaces that the frame shows: all that lights, the environment
/// and other surfaces send, in place of shadow maps, ambient occlusion and the split sum. Averages of many
/// samples converge to the solution of the rendering equation (Kajiya 1986).
template <template <class> class MaybeAuto>
struct BasicPathSettings {
    /// On: single frames too. Automatic: images of several samples if ssao.enabled, unless a setting of
    /// ssao, rays or shadows is given or a material has extensions of glTF.
    MaybeAuto<bool> enabled{};
    int bounces = 8;  ///< surfaces that a path meets after the one that is seen, 0 to 64
    /// Luminance, as exposed, that a path adds to its pixel beyond direct light while paths as bright are
    /// rare; what is above it is spread over the surfaces around. 0: none is spread.
    float clamp = 0.25f;
    Denoising denoise = Denoising::best;
};
using PathSettings = BasicPathSettings<Auto>;

}  // namespace easypbr
