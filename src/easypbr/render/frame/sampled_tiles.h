// The tiles of a picture of noisy light that still get samples.
#pragma once

#include <vector>

#include "easypbr/render/frame/tile_pixels.h"

namespace easypbr::render {

/// Each tile ends after some frame, or with the picture.
class SampledTiles : public TileGrid {
  public:
    /// Of a picture that has no frames yet.
    void begin(Vec2i size) {
        TileGrid::operator=(TileGrid(size));
        ended_.assign(count(), 0);
    }

    void end(size_t tile, int frames) { ended_[tile] = frames; }
    bool has_ended(size_t tile) const { return ended_[tile] > 0; }
    /// How many of the frames so far a tile has got.
    int frames_of(size_t tile, int so_far) const { return has_ended(tile) ? ended_[tile] : so_far; }

  private:
    std::vector<int> ended_;  ///< after how many frames; 0: not yet
};

}  // namespace easypbr::render
