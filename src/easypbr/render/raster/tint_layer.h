// What casters that let light through take from it, natively: a layer of ShadowTints in host memory.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
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
    /// The same with splats of any shape: `project(i)` makes one, whose first_row() and end_row() say which
    /// rows it may reach, and `cover(splat, part, put)` calls put(column, row, depth) for its texels in a
    /// part.
    template <class Project, class Cover>
    void draw_splats(size_t count, const Project& project, const Cover& cover,
                     const std::function<float(size_t splat)>& absorbed);

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

template <class Project, class Cover>
void TintLayer::draw_splats(size_t count, const Project& project, const Cover& cover,
                            const std::function<float(size_t splat)>& absorbed) {
    // So many at once: what is projected takes memory.
    constexpr size_t block = size_t(1) << 18;
    // Each band of rows takes all splats, in their order.
    const int bands = std::min(thread_count(), resolution_), rows = (resolution_ + bands - 1) / bands;
    std::vector<decltype(project(size_t(0)))> splats;
    for (size_t first = 0; first < count; first += block) {
        splats.resize(std::min(block, count - first));
        parallel_for(splats.size(), size_t(1) << 12, [&](size_t i) { splats[i] = project(first + i); });
        parallel_for(size_t(bands), 1, [&](size_t band) {
            const int top = int(band) * rows, bottom = std::min(top + rows, resolution_);
            if (top >= bottom) return;
            const PixelRect part{0, top, resolution_, bottom - top};
            for (size_t i = 0; i < splats.size(); ++i) {
                if (splats[i].first_row() >= bottom || splats[i].end_row() <= top) continue;
                const Vec3 value = Vec3::Constant(absorbed(first + i));
                cover(splats[i], part, [&](int column, int row, float depth) {
                    add(size_t(row) * size_t(resolution_) + size_t(column), depth, value.data());
                });
            }
        });
    }
}

}  // namespace easypbr::render
