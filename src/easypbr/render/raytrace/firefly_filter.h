// Light of rare bright paths, which would be single bright pixels.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"
#include "easypbr/render/raytrace/path_batch.h"

namespace easypbr::render {

/// Spreads light of rare bright paths over the surfaces around their pixels. How many paths as bright a pixel
/// is expected to have found is told by all pixels of its square, as in Zirr et al. 2018 ("Re-weighting
/// Firefly Samples for Improved Finite-Sample Monte Carlo Estimates"). Of n such paths the part p = n / (n +
/// 1) stays at its pixel: it makes the sum of the variance, p^2 / n of the square of the light, and of the
/// square of the bias least, which is (1 - p)^2 of it where spreading takes all light away. As samples are
/// added, n grows, and all light comes to stay where it is found.
class FireflyFilter {
  public:
    /// Pixels that light is added up in squares of.
    static constexpr int cell = 4;
    /// What a pixel gets depends on pixels no farther than this.
    static constexpr int reach = 6 * cell;

    /// Forgets the light of all frames.
    void begin_picture() { cells_found_.clear(); }
    /// Forgets the light that is to be spread. `most`: luminance of one path that is spread; what is above it
    /// would show as a spot, and is lost.
    void begin_frame(const Vec2i& size, float most);
    void end() { *this = {}; }

    /// Takes what is rare from the light beyond the limit, and adds the rest of it to that within.
    /// `radiance`: of a block's pixels, row by row. Safe to call from several threads for blocks of different
    /// whole cells.
    void take(const PixelRect& block, PathRadiance& radiance);

    /// Writes which part of light the pixels of a row scatter, 0 where they must not get any; not 0 where any
    /// was taken.
    using Reflectance = std::function<void(int y, std::span<Vec3> row)>;
    using Receive = std::function<void(int y, std::span<const Vec3> light)>;
    /// Calls `receive` with what the pixels of rows get: in proportion to their reflectance, less with the
    /// distance, and all together what was taken. Both are called from several threads.
    void spread(const Reflectance& reflectance, const Receive& receive);

  private:
    size_t cell_at(int column, int row) const { return size_t(row) * size_t(cells_.x()) + size_t(column); }
    /// The part of a path's light that stays at its pixel. `found`: luminance beyond the limit that all
    /// frames have found in its cell.
    static float staying(float found, float bright);

    /// The two cells of a row or column that a pixel lies between.
    struct Between {
        int first, second;
        float part;  ///< of the second
    };
    static Between between(int pixel, int cells);
    /// The reflectance of the pixels around the middle of each cell, by their distance.
    std::vector<Vec3> around(const Reflectance& reflectance) const;
    /// Spreads values over the cells around.
    void blur(std::vector<Vec3>& values) const;

    Vec2i size_{0, 0}, cells_{0, 0};
    std::vector<Between> columns_;  ///< of the pixels of a row
    float most_ = 0;
    std::vector<Vec3> taken_;         ///< for each cell
    std::vector<float> cells_found_;  ///< luminance beyond the limit, of all frames
};

}  // namespace easypbr::render
