// The tiles of a picture of noisy light that still get samples.
#pragma once

#include <algorithm>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"

namespace easypbr::render {

/// Squares of 16 x 16 pixels. Each ends after some frame, or with the picture.
class SampledTiles {
  public:
    static constexpr int side = 16;

    /// Of a picture that has no frames yet.
    void begin(Vec2i size) {
        size_ = size;
        columns_ = (size.x() + side - 1) / side;
        ended_.assign(size_t(columns_) * size_t((size.y() + side - 1) / side), 0);
    }

    size_t count() const { return ended_.size(); }
    /// Its pixels.
    PixelRect area_of(size_t tile) const {
        const int x = int(tile) % columns_ * side, y = int(tile) / columns_ * side;
        return {x, y, std::min(side, size_.x() - x), std::min(side, size_.y() - y)};
    }
    size_t tile_at(int x, int y) const { return size_t(y / side) * size_t(columns_) + size_t(x / side); }

    void end(size_t tile, int frames) { ended_[tile] = frames; }
    bool has_ended(size_t tile) const { return ended_[tile] > 0; }
    /// How many of the frames so far a tile has got.
    int frames_of(size_t tile, int so_far) const { return has_ended(tile) ? ended_[tile] : so_far; }

  private:
    Vec2i size_{0, 0};
    int columns_ = 0;
    std::vector<int> ended_;  ///< after how many frames; 0: not yet
};

}  // namespace easypbr::render
