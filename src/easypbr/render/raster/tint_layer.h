// What casters that let light through take from it, natively: a layer of ShadowTints in host memory.
#pragma once

#include <functional>
#include <span>
#include <variant>

#include "easypbr/core/math.h"
#include "easypbr/native/kernels.h"
#include "easypbr/render/raster/point_raster.h"
#include "easypbr/render/raster/triangle_raster.h"
#include "easypbr/scene/array.h"

namespace easypbr::render {

/// What texels of a caster absorb, r g b and opacity for each; their faces count from the first of the
/// triangles.
using TexelAbsorption =
    std::function<void(std::span<const native::VisiblePixel> texels, std::span<float> values)>;

/// Sums of what casters absorb, as shaders/shadow_target.glsl makes them. The casters of a texel are added in
/// the order in which they are drawn, face by face: the result does not depend on the number of threads.
class TintLayer {
  public:
    /// Four floats a texel, row by row. Nothing is drawn; the depths are `nothing`, before any.
    TintLayer(std::span<float> absorption, std::span<float> moment, int resolution, float nothing);

    int resolution() const { return resolution_; }
    /// Adds triangles; see TriangleRaster. `absorbed` is -ln(transmittance), the same everywhere or by texel.
    bool draw(const ScreenTriangles& triangles, const std::variant<Vec3, TexelAbsorption>& absorbed);

    /// Adds points; each absorbs its own share of all colours.
    void draw_points(const Array3f& V, const PointSplats& splats,
                     const std::function<float(size_t point)>& absorbed);

    /// What several casters absorb together.
    struct Absorbed {
        Vec3 absorption, moment;
        float first, last;  ///< depths, of the nearest to the light and of the farthest
    };
    /// For different texels also from several threads.
    void add(size_t texel, const Absorbed& absorbed);

  private:
    class Texels;
    void add(size_t texel, float depth, const float* absorbed);

    std::span<float> absorption_, moment_;
    int resolution_;
    TriangleRaster raster_;
};

}  // namespace easypbr::render
