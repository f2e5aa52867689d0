// Sets of splats blended into a picture, tile by tile on all cores.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/primitives/splats/splat_set.h"
#include "easypbr/render/primitives/splats/splat_tile.h"
#include "easypbr/scene/settings.h"

namespace easypbr::render {

/// Blends all splats of all sets in one order, that of the depths of their means, as they were trained
/// (Kerbl et al. 2023): sRGB-encoded colours, from the nearest to the farthest. The picture depends neither
/// on the number of threads nor on the order of splats and sets.
class SplatCompositor {
  public:
    /// Projects and sorts the splats of the items. `finish` gives them their colours.
    void begin(const Frame& frame, const std::vector<const DrawItem*>& items, const SplatSet::Finish& finish);
    bool empty() const { return set_.empty(); }

    /// Reversed depth of every pixel of the frame, row by row: splats are blended from `farthest` to before
    /// `nearest`. Either may be empty: no limit. `farthest` is 0 where there is none.
    struct Limits {
        std::span<const float> farthest, nearest;
    };
    using Take = std::function<void(const SplatTile&)>;
    /// Calls take(tile) for each tile that has splats, with all of them blended, from any thread.
    void blend(const Limits& limits, const Take& take) { blend(limits, take, false); }
    /// With SplatTile::positions.
    void blend_with_positions(const Limits& limits, const Take& take) { blend(limits, take, true); }

    Vec2i size() const { return set_.size(); }
    const ProjectedSplat& splat(uint32_t place) const { return set_.splats()[place]; }
    const DrawItem& item_of(uint32_t place) const { return set_.item_of(place); }

  private:
    void blend(const Limits& limits, const Take& take, bool sums_positions);

    SplatSet set_;
    SplatSettings settings_;
    DepthAxis axis_;
};

}  // namespace easypbr::render
