// Surfels into the G-buffer without the driver: for machines without a GPU.
#pragma once

#include "easypbr/render/primitives/surfels/surfel_tile.h"
#include "easypbr/render/raster/visibility.h"

namespace easypbr::render {

/// Surface splatting in two passes and a normalisation (Botsch et al. 2005), tile by tile: the nearest
/// distance of each pixel, pushed back by the splat's radius; then weighted sums of all that lies before it;
/// then their quotients.
class SoftwareSurfels {
  public:
    /// `opaque`: reversed depth of what hides surfels, for the whole frame row by row. `writer` holds the
    /// same frame, and keeps what is nearer. `nearest_alone`: each pixel's surface is the nearest surfel
    /// alone.
    void draw(const Frame& frame, const std::vector<SurfelSource>& sources, std::span<const float> opaque,
              bool nearest_alone, SurfaceWriter& writer);

    // Layers, see SurfelLayers: begin_layers() once, then add_layer() for each, with the same sources.

    /// Nothing behind `opaque` (reversed depths of what is covered of the frame, row by row) is drawn.
    void begin_layers(const Frame& frame, const std::vector<SurfelSource>& sources,
                      std::span<const float> opaque);
    /// Adds each source's next surface to a layer that the writer holds the whole frame of: where it is
    /// farther than what is there, or, where the limits ask for the nearest, nearer. The limits are set where
    /// that is so. False: there was none.
    bool add_layer(const Frame& frame, const std::vector<SurfelSource>& sources, PeelLimits& limits,
                   SurfaceWriter& writer);

  private:
    /// Surfels whose projections are kept in a frame: 92 MB.
    static constexpr size_t most_kept = size_t(1) << 20;

    void bin(const std::vector<SurfelSource>& sources, Vec2i frame);
    Vec2i tiles_of(Vec2i frame) const { return (frame.array() + SurfelTile::size - 1) / SurfelTile::size; }
    std::span<const uint64_t> entries_of(size_t tile) const {
        return {entries_.data() + first_[tile], first_[tile + 1] - first_[tile]};
    }
    void draw_tile(const Frame& frame, const std::vector<SurfelSource>& sources,
                   std::span<const float> opaque, bool nearest_alone, Vec2i place,
                   std::span<const uint64_t> entries, SurfaceWriter& writer) const;
    bool add_layer(const Frame& frame, const std::vector<SurfelSource>& sources, Vec2i place,
                   std::span<const uint64_t> entries, PeelLimits& limits, SurfaceWriter& writer);

    /// Projections of each source, by surfel; empty: there are too many to keep.
    std::vector<std::vector<SurfelProjection>> kept_;
    std::vector<size_t> first_;             ///< of each tile in entries_, and the end
    std::vector<uint64_t> entries_;         ///< source in the upper, surfel in the lower half
    std::vector<std::vector<float>> ends_;  ///< of each source: where its last layer ended, axial distances
};

}  // namespace easypbr::render
