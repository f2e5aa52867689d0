// Surfels into the G-buffer without the driver: for machines without a GPU.
#pragma once

#include "easypbr/render/primitives/surfels/surfel_projection.h"
#include "easypbr/render/raster/surface_writer.h"

namespace easypbr::render {

/// Surface splatting in two passes and a normalisation (Botsch et al. 2005), tile by tile: the nearest
/// distance of each pixel, pushed back by the splat's radius; then weighted sums of all that lies before it;
/// then their quotients. Sums are of whole numbers, so that the picture does not depend on the order of the
/// surfels.
class SoftwareSurfels {
  public:
    struct Source {
        const DrawItem* item;
        SurfelProjector projector;
    };

    /// `opaque`: reversed depth of what hides surfels, for the whole frame row by row. `writer` holds the
    /// same frame, and keeps what is nearer.
    void draw(const Frame& frame, const std::vector<Source>& sources, std::span<const float> opaque,
              SurfaceWriter& writer);

  private:
    struct Tile;
    void bin(const std::vector<Source>& sources, Vec2i tiles);
    void draw_tile(const Frame& frame, const std::vector<Source>& sources, std::span<const float> opaque,
                   Vec2i tile, std::span<const uint64_t> surfels, SurfaceWriter& writer) const;

    std::vector<size_t> first_;      ///< of each tile in entries_, and the end
    std::vector<uint64_t> entries_;  ///< source in the upper, surfel in the lower half
};

}  // namespace easypbr::render
