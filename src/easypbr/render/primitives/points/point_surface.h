// The points of a cloud as the native rasteriser draws them.
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/primitives/points/point_order.h"
#include "easypbr/render/raster/visible_surfaces.h"

namespace easypbr::render {

/// A cloud item with all that its pixels need. Its points are numbered as they are drawn: in the order of the
/// batches where there are any.
class PointSurface final : public VisibleItem {
  public:
    /// The order must live as long.
    PointSurface(const DrawItem& item, const Frame& frame, const PointOrder& order);

    void resolve(const Frame& frame, const DrawItem& item, std::span<const native::VisiblePixel> pixels,
                 SurfaceWriter& writer) const override;

    /// By colour, opacity and normal as bits: what tells points apart in the picture.
    PointRank rank(uint32_t point) const override;

  private:
    uint32_t vertex_of(uint32_t point) const {
        return order_.batches ? order_.batches->vertex_of(point) : point;
    }
    Vec3 color(uint32_t point) const;
    void prefetch(uint32_t point) const;
    /// From what a pixel shows to the viewer, in world space.
    Vec3 towards_viewer(int x, int y) const { return towards_first_ + float(x) * column_ + float(y) * row_; }
    /// Unit, world, on the side that is seen there.
    Vec3 normal(uint32_t vertex, int x, int y) const;

    const DrawItem* item_;
    PointOrder order_;
    Mat3 normal_from_mesh_;
    Vec3 towards_first_, column_, row_;  ///< of the pixel in column 0 and row 0, and on to the next ones
};

}  // namespace easypbr::render
