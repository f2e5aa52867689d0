// Squares of a picture's pixels, and values that only some of them have.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <type_traits>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/memory_pool.h"
#include "easypbr/core/picture.h"

namespace easypbr::render {

/// Squares of 16 x 16 pixels, row by row; those at the right and below may be cut.
class TileGrid {
  public:
    static constexpr int side = 16;

    TileGrid() = default;
    explicit TileGrid(Vec2i size)
        : size_(size), columns_((size.x() + side - 1) / side), rows_((size.y() + side - 1) / side) {}

    Vec2i size() const { return size_; }
    size_t count() const { return size_t(columns_) * size_t(rows_); }
    /// Its pixels.
    PixelRect area_of(size_t tile) const {
        const int x = int(tile) % columns_ * side, y = int(tile) / columns_ * side;
        return {x, y, std::min(side, size_.x() - x), std::min(side, size_.y() - y)};
    }
    size_t tile_at(int x, int y) const { return size_t(y / side) * size_t(columns_) + size_t(x / side); }
    /// Of a pixel among those of its tile.
    static size_t place_of(int x, int y) { return size_t(y % side) * side + size_t(x % side); }
    /// The tiles that have pixels of a rectangle inside the picture.
    std::vector<size_t> tiles_in(const PixelRect& area) const {
        std::vector<size_t> tiles;
        if (area.width <= 0 || area.height <= 0) return tiles;
        for (int y = area.y / side; y <= (area.y + area.height - 1) / side; ++y)
            for (int x = area.x / side; x <= (area.x + area.width - 1) / side; ++x)
                tiles.push_back(size_t(y) * size_t(columns_) + size_t(x));
        return tiles;
    }

  private:
    Vec2i size_{0, 0};
    int columns_ = 0, rows_ = 0;
};

/// Values of a picture's tiles, Values() at first. Tiles take memory once they are written: together, so that
/// it goes back to the system when it is released.
template <class Values>
class TileValues {
  public:
    /// Forgets all values.
    void begin(Vec2i size) {
        release();
        grid_ = TileGrid(size);
        tiles_.resize(grid_.count());
    }
    void release() {
        std::vector<Values*>().swap(tiles_);
        blocks_.clear();
        free_ = 0;
        grid_ = TileGrid();
    }
    const TileGrid& grid() const { return grid_; }

    /// Null where all are as at first.
    Values* of(size_t tile) const { return tiles_[tile]; }
    /// The same to write to. Threads may do so with different tiles at a time.
    Values& make(size_t tile) {
        if (!tiles_[tile]) tiles_[tile] = std::construct_at(take());
        return *tiles_[tile];
    }

  private:
    static constexpr size_t tiles_of_block = (size_t(1) << 20) / sizeof(Values);
    static_assert(std::is_trivially_destructible_v<Values>);

    /// Room for a tile.
    Values* take() {
        const std::lock_guard lock(mutex_);
        if (free_ == 0) {
            blocks_.emplace_back(tiles_of_block * sizeof(Values));
            free_ = tiles_of_block;
        }
        return reinterpret_cast<Values*>(blocks_.back().data()) + --free_;
    }

    TileGrid grid_;
    std::vector<Values*> tiles_;
    std::mutex mutex_;
    std::vector<PooledVector<std::byte>> blocks_;
    size_t free_ = 0;  ///< tiles of the last block
};

/// A value for each pixel of a tile, by TileGrid::place_of().
template <class T>
struct PixelsOfTile {
    T& operator[](size_t place) { return values[place]; }
    const T& operator[](size_t place) const { return values[place]; }

    std::array<T, size_t(TileGrid::side) * TileGrid::side> values{};
};

/// A value for each pixel, T() at first.
template <class T>
class TilePixels : public TileValues<PixelsOfTile<T>> {
  public:
    T at(int x, int y) const {
        const auto* tile = this->of(this->grid().tile_at(x, y));
        return tile ? (*tile)[TileGrid::place_of(x, y)] : T();
    }
};

}  // namespace easypbr::render
