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
    int x0 = 0, x1 = 0;      ///< columns that are shaded
};

/// Shades rows [y0, y1) of a region; `uniforms` are those of the shader.
using ShadeRows = void (*)(const void* uniforms, const Region& region, int y0, int y1);

/// Triangles whose nearest one is known for each pixel, and the targets that their surfaces are written to.
struct VisibleTriangles {
    const float *V = nullptr, *N = nullptr;  ///< vertices and their normals, x y z
    const int32_t* F = nullptr;              ///< three indices a face
    uint32_t first_face = 0;                 ///< faces of pixels count from here
    double clip_from_mesh[4][4] = {};
    float normal_from_mesh[3][3] = {};         ///< to world space
    bool flat = false;                         ///< normals of faces in place of N
    bool two_sided = false;                    ///< normals are on the side that is seen
    bool normals_agree = false;                ///< the winding tells the side of N
    bool mirrored = false;                     ///< front faces are clockwise
    double pixel_width = 0, pixel_height = 0;  ///< in normalised device coordinates
    uint64_t albedo = 0;                       ///< of all pixels, in the formats of the targets
    uint32_t material = 0, id = 0;

    uint64_t* albedos = nullptr;
    uint32_t *normals = nullptr, *materials = nullptr, *ids = nullptr, *elements = nullptr;
    float* depths = nullptr;  ///< ids and elements: null where they are not asked for
};

/// A pixel that a triangle was found in.
struct VisiblePixel {
    int32_t x = 0;
    uint32_t face = 0;
};

/// Writes the surfaces of pixels of row `y`, which stand in the targets from `row` on, less `first_x`.
using ResolveTriangles = void (*)(const VisibleTriangles& triangles, const VisiblePixel* pixels, int count,
                                  int y, size_t row, int first_x);

struct Kernels {
    ResolveTriangles resolve_triangles;
    ShadeRows lighting_surface, background_environment, display_output, accumulate_sample, antialias_fxaa,
        occlusion_select, occlusion_horizon, occlusion_hemisphere, occlusion_blur, occlusion_magnify;
};

}  // namespace easypbr::native
