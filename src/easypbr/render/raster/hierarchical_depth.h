// The farthest depth of blocks of pixels: what lies behind a block's is hidden by what is drawn already
// (Greene, Kass and Miller 1993, "Hierarchical Z-buffer visibility").
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/raster/culling.h"

namespace easypbr::render {

/// A block's depth is found when it is asked for and kept while it suffices: depths of pixels only rise, so
/// that an older one hides less and never too much. Any thread, while others draw.
class HierarchicalDepth {
  public:
    static constexpr int block_size = 8;

    /// Nothing hides anything; `area` is what pixels are counted in.
    void clear(const PixelRect& area) {
        area_ = area;
        columns_ = (area.width + block_size - 1) / block_size;
        const int rows = (area.height + block_size - 1) / block_size;
        farthest_.assign(size_t(columns_) * size_t(rows), 0.0f);
    }

    /// Whether all pixels that something may cover are nearer than it. depth_at(pixel of the area): the
    /// reversed depth seen there now, 0 or less where there is nothing.
    template <class DepthAt>
    bool hides(const ScreenBounds& bounds, const DepthAt& depth_at) {
        if (bounds.empty()) return true;
        const int x0 = (bounds.left - area_.x) / block_size, x1 = (bounds.right - area_.x) / block_size,
                  y0 = (bounds.top - area_.y) / block_size, y1 = (bounds.bottom - area_.y) / block_size;
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const std::atomic_ref<float> kept(farthest_[size_t(y) * size_t(columns_) + size_t(x)]);
                if (kept.load(std::memory_order_relaxed) > bounds.nearest) continue;
                const float farthest = farthest_of(x, y, bounds.nearest, depth_at);
                if (!(farthest > bounds.nearest)) return false;
                kept.store(farthest, std::memory_order_relaxed);
            }
        return true;
    }

  private:
    /// Of a block's pixels; of the first ones where these are not nearer than `nearest`.
    template <class DepthAt>
    float farthest_of(int column, int row, float nearest, const DepthAt& depth_at) const {
        const int left = column * block_size, width = std::min(block_size, area_.width - left);
        const int top = row * block_size, bottom = std::min(top + block_size, area_.height);
        float farthest = 2;
        for (int y = top; y < bottom && farthest > nearest; ++y) {
            const size_t first = size_t(y) * size_t(area_.width) + size_t(left);
            for (int x = 0; x < width; ++x) farthest = std::min(farthest, depth_at(first + size_t(x)));
        }
        return farthest;
    }

    PixelRect area_;
    int columns_ = 0;
    std::vector<float> farthest_;
};

}  // namespace easypbr::render
