// Native shaders as the instruction sets export them. Plain data only.
#pragma once

#include <cstddef>

#include "easypbr/native/views.h"

namespace easypbr::native {

/// What becomes of a pixel.
enum class Store {
    replace,
    add_light,  ///< colours are added, alpha stays
    add         ///< all channels are added
};
enum class Pixels {
    rgba8,   ///< rounded to 8 bits
    rgba16,  ///< rounded to 16 bits
    rgba32f,
    r16  ///< rounded to 16 bits
};
/// The pixels that are shaded.
enum class Where {
    everywhere,
    covered,  ///< where `depth` is not 0; with Store::replace other pixels become 0
    empty     ///< where it is 0
};

/// Pixels that are written, and which of them.
struct Region {
    std::byte* data = nullptr;  ///< row by row
    Pixels pixels = Pixels::rgba32f;
    int x = 0, y = 0, width = 0;  ///< first pixel that the data holds, and of how many columns
    Store store = Store::replace;
    Where where = Where::everywhere;
    R32f depth = {};
    int depth_channels = 1;  ///< of the pixels of `depth`, which is the first
    int x0 = 0, x1 = 0;  ///< columns that are shaded
};

/// Shades rows [y0, y1) of a region; `uniforms` are those of the shader.
using ShadeRows = void (*)(const void* uniforms, const Region& region, int y0, int y1);

struct Kernels {
    ShadeRows lighting_surface, background_environment, display_output, accumulate_sample, antialias_fxaa, occlusion_select,
        occlusion_horizon, occlusion_hemisphere, occlusion_blur, occlusion_magnify;
};

}  // namespace easypbr::native
