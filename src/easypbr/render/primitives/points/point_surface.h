// The points of a cloud as the native rasteriser draws them.
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/raster/visible_surfaces.h"

namespace easypbr::render {

/// A cloud item with all that its pixels need.
class PointSurface final : public VisibleItem {
  public:
    PointSurface(const DrawItem& item, const Frame& frame);

    void resolve(const Frame& frame, const DrawItem& item, std::span<const native::VisiblePixel> pixels,
                 SurfaceWriter& writer) const override;

    /// Colour, opacity and normal as bits: what tells points apart in the picture.
    uint64_t content(uint32_t point) const override;

  private:
    /// What the point looks like from the eye; its depth is left out.
    SurfacePixel at(uint32_t point) const;
    Vec3 color(uint32_t point) const;
    void prefetch(uint32_t point) const;

    const DrawItem* item_;
    Mat3 normal_from_mesh_, world_from_mesh_;
    Vec3 view_position_;   ///< of the eye, in the mesh's frame
    Vec3 view_direction_;  ///< towards an orthographic viewer, in the mesh's frame
    bool orthographic_;
};

}  // namespace easypbr::render
