// Splats of several objects as a view sees them, in its order, tile by tile.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/primitives/splats/splat_order.h"

namespace easypbr::render {

class SplatSet {
  public:
    /// Changes splats of an item, from several threads.
    using Finish = std::function<void(const SplatProjector&, const DrawItem&, std::span<ProjectedSplat>)>;

    /// Projects and sorts the splats of the items. `finish` gets all that are seen, some at a time.
    void begin(const SplatView& view, const std::vector<const DrawItem*>& items, const Finish& finish = {});
    /// Calls body(column, row, places) for each tile that has splats, from the nearest on, from any thread.
    void for_each_tile(const std::function<void(int, int, std::span<const uint32_t>)>& body);

    bool empty() const { return order_.empty(); }
    Vec2i size() const { return size_; }
    /// By their places, of which not all hold one.
    std::span<const ProjectedSplat> splats() const { return {splats_.get(), room_}; }
    const DrawItem& item_of(uint32_t place) const;

  private:
    /// Projects an item's splats to the places from `first` on, and adds the places of those that are seen.
    void project(const SplatView& view, const DrawItem& item, size_t first, const Finish& finish);

    Vec2i size_{0, 0};
    std::vector<const DrawItem*> items_;
    std::vector<size_t> ends_;  ///< of each item's places
    /// Each has its place, so that nothing is copied; memory that nothing is written to is not taken.
    std::unique_ptr<ProjectedSplat[]> splats_;
    size_t room_ = 0;
    std::vector<uint32_t> order_;
    SplatTiles tiles_;
    size_t entries_ = 0;  ///< of all tiles' lists
};

}  // namespace easypbr::render
