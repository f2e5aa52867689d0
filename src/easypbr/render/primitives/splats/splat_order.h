// Splats in the order in which they are seen, and which of them each tile of the screen shows.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/render/primitives/splats/splat_projection.h"

namespace easypbr::render {

/// Places of splats from the nearest to the farthest. Of those of equal depth the order is that of what they
/// look like, so that it does not depend on the order in which they are given.
std::vector<uint32_t> front_to_back(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places);

/// Lists of the splats in tiles of a band of the screen.
class SplatTiles {
  public:
    static constexpr int tile_size = native::SplatPixels::size;

    /// Finds the tiles that splats are seen in, in the order of `order`. Returns how many entries the lists
    /// of the whole screen have.
    size_t begin(std::span<const ProjectedSplat> splats, std::span<const uint32_t> order, Vec2i size);

    /// Makes the lists of the rows of tiles from `first_row` to before `end_row`, in the same order.
    void bin(std::span<const uint32_t> order, int first_row, int end_row);
    /// Number of tiles in a row.
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    std::span<const uint32_t> of(int column, int row) const {
        const size_t tile = size_t(row - first_row_) * size_t(columns_) + size_t(column);
        return {entries_.get() + first_[tile], first_[tile + 1] - first_[tile]};
    }
    /// Frees what the lists take.
    void clear();

  private:
    /// Tiles from the first to before the end.
    struct Box {
        uint16_t x0, y0, x1, y1;
    };
    static Box box_of(const ProjectedSplat& splat, int columns, int rows);

    int columns_ = 0, rows_ = 0, first_row_ = 0;
    std::unique_ptr<Box[]> boxes_;
    std::vector<size_t> first_;  ///< of each tile in entries_, and the end
    std::unique_ptr<uint32_t[]> entries_;
};

}  // namespace easypbr::render
