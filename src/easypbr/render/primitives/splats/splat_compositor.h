// Sets of splats blended into a picture, tile by tile on all cores.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/primitives/splats/splat_tile.h"

namespace easypbr::render {

/// Blends all splats of all sets in one order, that of the depths of their means, as they were trained
/// (Kerbl et al. 2023): sRGB-encoded colours, from the nearest to the farthest. The picture depends neither
/// on the number of threads nor on the order of splats and sets.
class SplatCompositor {
  public:
    /// Projects and sorts the splats of the items.
    void begin(const Frame& frame, const std::vector<const DrawItem*>& items);
    bool empty() const { return splats_.empty(); }

    /// Reversed depth of every pixel of the frame, row by row: splats are blended from `farthest` to before
    /// `nearest`. Either may be empty: no limit.
    struct Limits {
        std::span<const float> farthest, nearest;
    };
    /// Calls take(tile) for each tile that has splats, with all of them blended, from any thread.
    void blend(const Limits& limits, const std::function<void(const SplatTile&)>& take);

    Vec2i size() const { return size_; }
    const ProjectedSplat& splat(uint32_t place) const { return splats_[place]; }
    const DrawItem& item_of(uint32_t place) const;

  private:
    Vec2i size_{0, 0};
    std::vector<const DrawItem*> items_;
    std::vector<size_t> ends_;  ///< of each item's splats
    std::vector<ProjectedSplat> splats_;
    std::vector<uint32_t> order_;
    SplatTiles tiles_;
};

}  // namespace easypbr::render
